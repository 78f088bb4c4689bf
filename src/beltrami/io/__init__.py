"""Files in, files out: meshes by suffix, functions on their vertices."""
