"""Many runs of one scenario: planned, made side by side, gone on with, and found again."""
