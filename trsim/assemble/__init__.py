"""From a scenario to arrays and the equations of motion."""
