"""Impacts under a force law: declared as sympy, integrated, and the parameters that simulation codes need."""
