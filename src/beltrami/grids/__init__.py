"""Periodic grids: convolution, the Fourier transform, closed-form spectra (3.2.4, 3.2.6, 3.3.3)."""
