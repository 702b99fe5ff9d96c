"""`python -m loopsheet`: the same as the command `loopsheet`."""

import os
import sys

from .report.cli import command

if __name__ == "__main__":
    # `python -m` looks for modules where one stands first: a numpy.py in a report folder is none of ours.
    if sys.path[0] == os.getcwd():
        del sys.path[0]
    command()
