"""Command-line tools for NML buffers: nmlcheck, nmlstat, nmlsend, nmllog."""
