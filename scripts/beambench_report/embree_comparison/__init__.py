"""Tile beams against Embree's fastest mode on the same rays, with targets."""
