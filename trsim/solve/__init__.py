"""From a mechanism to its motion: start, march, events, integrators."""
