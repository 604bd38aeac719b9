"""Compares tile beams with Embree's fastest mode on the same rays, and with targets."""
