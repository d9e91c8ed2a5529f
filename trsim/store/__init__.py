"""Result files: one HDF5 file per run, written while it runs."""
