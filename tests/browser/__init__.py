"""End-to-end tests of the web display in a real browser."""
