"""What tests share: scenes, decks, models that are watched, a browser without a window."""
