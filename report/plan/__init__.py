"""A sheet lowered to what is computed, node by node, in plain symbols: what engines print or walk.

The sheet says what its author means, in cells of rows: ``x_p[j]``. The plan says what that takes: which array
a symbol stands for, which sums are taken before, what is asked of a value. All of it is made once, here.
"""

from __future__ import annotations

from .lowering import lowered, lowered_column
from .nodes import (
    GivenNode,
    Leaf,
    Map,
    Node,
    Part,
    Plan,
    RootNode,
    RowMedian,
    RowSum,
    Total,
    free_name,
    taken_over,
)

__all__ = [
    "GivenNode",
    "Leaf",
    "Map",
    "Node",
    "Part",
    "Plan",
    "RootNode",
    "RowMedian",
    "RowSum",
    "Total",
    "free_name",
    "lowered",
    "lowered_column",
    "taken_over",
]
