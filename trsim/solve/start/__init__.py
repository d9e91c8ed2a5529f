"""Where a run starts: consistent positions and velocities, equilibrium."""
