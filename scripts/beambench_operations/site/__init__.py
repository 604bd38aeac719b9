"""A site of plain files over all runs: index, pages, comparisons, histories."""
