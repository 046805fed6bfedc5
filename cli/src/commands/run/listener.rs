//! Standard output of a run, whose reader may close it.

use std::io::{self, Write};

/// Standard output of a run. If the results are written to files, the run continues without a reader.
pub(super) struct Listener<'a, 'b> {
    pub out: &'a mut (dyn Write + 'b),
    pub may_go: bool,
    pub gone: bool,
}

impl Write for Listener<'_, '_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.gone {
            return Ok(bytes.len());
        }
        match self.out.write(bytes) {
            Err(error) if self.may_go && error.kind() == io::ErrorKind::BrokenPipe => {
                self.gone = true;
                Ok(bytes.len())
            }
            other => other,
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self.gone {
            true => Ok(()),
            false => self.out.flush(),
        }
    }
}
