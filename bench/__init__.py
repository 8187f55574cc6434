"""Speed and memory, beside the plain way of doing the same job in the same run: `make bench`."""
