"""Meshes: the topology (V, E, F), its geometric realisation, defects and shapes (chapter 3.1)."""
