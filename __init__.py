"""loopsheet: measured columns and published equations in, a report that can be refereed out."""

__version__ = "0.1.0"
