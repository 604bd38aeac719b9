"""Tile beams against Embree's fastest mode on the same image, with targets."""
