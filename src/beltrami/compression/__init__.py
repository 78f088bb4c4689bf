"""Compression: meshes as few bytes, with an error that is stated (section 3.3.6)."""
