"""Distances along the surface."""
