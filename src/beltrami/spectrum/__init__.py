"""The eigenvectors of the pair (L, B), and what they are good for (chapter 3.3.2 to 3.3.4)."""
