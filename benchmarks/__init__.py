"""Measurements, printed and never asserted."""

import os

# as the command line does it: threads that wait for work count as CPU time of whatever runs then
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
