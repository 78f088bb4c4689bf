"""Parametric surfaces: first fundamental form, Laplace-Beltrami, charts (3.1.1, 3.2.7)."""
