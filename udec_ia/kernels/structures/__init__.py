"""Structures: bolts between blocks (BOLT). A scene without them runs nothing of it."""
