"""Operators as arrays for networks on surfaces, kept on disk by their content."""
