"""Scenes drawn by the thousand, each judged in a way that shares nothing with trsim's own."""
