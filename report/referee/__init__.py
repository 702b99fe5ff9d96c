"""The referee: whether printed results are reachable from printed inputs."""

from .comparison import compare, print_as, prints_same, refereed

__all__ = ["compare", "print_as", "prints_same", "refereed"]
