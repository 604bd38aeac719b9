"""Makes results/published: the runs, and the texts from their committed rows."""
