"""The page of a run: one HTML file that holds everything and asks nothing of a network."""
