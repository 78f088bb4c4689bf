"""Diffusion: smoothing and heat (sections 3.2.2 and 3.3.1)."""
