//! Nothing: the models are part of the test, so that only those who run it compile them.
