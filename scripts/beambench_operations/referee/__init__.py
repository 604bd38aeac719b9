"""The referee's table: how many hits of other projects' libraries are correct."""
