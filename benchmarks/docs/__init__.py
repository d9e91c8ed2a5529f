"""Documents that stay true: markers round what is measured, and what makes it again."""
