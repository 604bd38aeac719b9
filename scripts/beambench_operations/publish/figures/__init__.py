"""What the texts of results/published state: a module for each folder computes it from its rows."""
