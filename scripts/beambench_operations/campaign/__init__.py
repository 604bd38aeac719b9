"""Long campaigns that test the program by random inputs, rays and kills, with one record."""
