"""The gallery of docs/gallery.md: a picture, the scenario and the commands of every template.

`python -m benchmarks.gallery` makes all of it again, or the pictures of the templates it is given.
"""
