"""`python -m loopsheet`: the same as the command `loopsheet`."""

from .report.cli import main

if __name__ == "__main__":
    raise SystemExit(main())
