"""Contact models of the literature, a module each."""
