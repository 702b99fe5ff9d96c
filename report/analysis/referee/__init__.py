"""The referee: whether printed results are reachable from printed inputs."""

from .comparison import compare, print_as, prints_same, refereed
from .judging import referee

__all__ = ["compare", "print_as", "prints_same", "referee", "refereed"]
