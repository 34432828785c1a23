"""LinuxCNC's package for previews: ``rs274.interpret`` has the callbacks that displays build on."""
