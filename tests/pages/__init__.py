"""README and the pages of docs: what is measured, what is run, what is listed."""
