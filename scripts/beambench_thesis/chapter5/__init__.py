"""Studies of chapter 5: best parameters, costs, levels, sampling, counts of single commands."""
