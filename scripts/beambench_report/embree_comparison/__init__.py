"""Tile beams against the fastest way that Embree traces the same image, with targets."""
