"""Geometry without topology: shapes of blocks, tensors, tolerances, boxes, contacts."""
