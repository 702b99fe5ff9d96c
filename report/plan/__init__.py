"""A sheet lowered to what is computed, node by node, in plain symbols: what engines print or walk.

The sheet says what its author means, in cells of rows: ``x_p[j]``. The plan says what that takes: which array
a symbol stands for, which sums are taken before, what is asked of a value. All of it is made once, here.
"""
