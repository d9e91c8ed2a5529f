"""What can be said of a start and of a run: scales, modes, doubts and their reasons."""
