"""The command line: one file for each verb."""

from __future__ import annotations

import sys

INTERRUPTED = 130  # 128 + SIGINT, as shells have it


def main() -> None:
    """Run ``beltrami``: the entry point of the command."""
    try:
        from beltrami.cli.interrupts import hear_again  # nothing is loaded with the package

        sys.unraisablehook = hear_again
        from beltrami.cli.app import app

        app()
    except KeyboardInterrupt:
        pass
    except SystemExit as end:
        if end.code != INTERRUPTED:
            raise
    sys.stderr.write("beltrami: interrupted\n")
    sys.exit(INTERRUPTED)
