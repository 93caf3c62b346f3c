"""The methods of Model in families, each a class that Model is made of; those that run stand in model.py."""
