"""One pipeline over many meshes: on this machine or on a cluster, with nothing lost."""
