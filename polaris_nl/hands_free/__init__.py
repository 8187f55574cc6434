"""Hands free: a session and speech brought together, from sound to what is said back."""
