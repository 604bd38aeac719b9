"""Haines's tests of the Standard Procedural Databases (1987), counted again."""
