"""Pictures of meshes and of functions on them, with no GL and no window (l. 70, 107)."""
