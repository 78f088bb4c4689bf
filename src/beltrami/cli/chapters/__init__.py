"""The chapters of the tour: each runs one part of the library on the mesh of the tour."""
