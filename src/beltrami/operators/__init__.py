"""Operators: a mesh becomes matrices (sections 3.2.1 to 3.2.3 and 3.2.5)."""
