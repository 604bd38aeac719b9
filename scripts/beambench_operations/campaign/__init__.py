"""Long campaigns against the program: inputs, rays and kills at random, counted in one record."""
