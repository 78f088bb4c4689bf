"""``python -m beltrami``: the command line where its command is not on the path."""

from __future__ import annotations

from beltrami.cli import main

if __name__ == "__main__":
    main()
