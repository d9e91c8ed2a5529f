"""Scenes drawn by the thousand, each judged in a way that shares nothing with trsim's own."""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy comes: many small matrices
