"""Real meshes from package registries and from a user's own downloads, for scripts/meshes.

The package needs only Python, because scripts/meshes may be the first script that a user runs.
"""
