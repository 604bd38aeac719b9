"""Havran's comparison of octrees (1999), measured again."""
