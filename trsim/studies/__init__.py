"""Published studies, run and judged with trsim as anybody could."""
