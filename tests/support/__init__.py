"""Helpers of the tests: whole machines in namespaces of their own, clients, and an independent check of motion."""
