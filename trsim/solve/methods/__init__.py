"""The methods of integration, one file each, and the algebra they need."""
