"""Frozen values of the domain and the world, and their readers. Imports nothing of the rest."""
