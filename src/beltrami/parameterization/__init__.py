"""Maps of surfaces to the plane, certified (chapter 3.3.7 and 3.3.8)."""
