"""Static paths: equilibrium at each place of a driven motion."""
