"""All that the service knows, in one file: records of either database and blobs, verified by hash both ways."""
