"""How Python functions become machine code: records, compiling, and what is kept of it."""
