"""Distances along the surface: the heat method, exact polyhedral ones, and paths of edges."""
