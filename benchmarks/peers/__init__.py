"""Other engines on the same problems, where they are installed."""


def compare(*a):
    pass
