"""The configuration wizard: questions, and the INI, HAL, NML, tool and parameter files that the answers make.

``questions`` is the form, ``answers`` checks what was filled in, ``inifile`` and ``halfile`` write the two long
files, ``make`` puts a whole folder there; ``samples`` copies a configuration that comes with us, ``server`` shows
all of it in a browser.
"""
