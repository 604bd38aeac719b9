"""Long campaigns against the program: random inputs, rays and kills, counted in one record."""
