"""Physics and algebra: what is true, and the proof of it. sympy only."""
