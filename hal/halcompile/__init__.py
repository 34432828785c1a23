"""``halcompile``: components in LinuxCNC's .comp language, or in C, become what `loadrt` and `loadusr` find.

``language`` reads a .comp file into a `Component`, ``source`` writes the C of it, ``manpage`` its manual page, and
``program`` is the command, which has gcc compile it against ``hal/include``.
"""
