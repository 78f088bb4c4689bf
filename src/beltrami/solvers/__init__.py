"""Solvers: linear algebra that knows no mesh."""
