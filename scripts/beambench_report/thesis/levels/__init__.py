"""The level that max_level=auto chooses beside the best of the levels that were measured."""
