"""The command ``clebsch``, as ``python -m clebsch`` runs it."""

import signal
import sys

from ._clebsch import command


def main() -> int:
    """Run the command with the arguments of the process.

    Returns
    -------
    int
        The exit code of the command.
    """
    # The command handles Ctrl-C itself: it stops at the next step and writes its results.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return command(sys.argv[1:])


if __name__ == "__main__":
    sys.exit(main())
