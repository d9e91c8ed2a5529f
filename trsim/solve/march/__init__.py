"""The time loop: a step, its acceptance, events, and everything a run keeps."""
