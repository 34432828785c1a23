"""``mb2hal``: registers, coils and inputs of Modbus devices as HAL pins.

``protocol`` makes requests and reads answers, ``links`` carries them over TCP or a serial line, ``config`` reads the
INI file, ``bridge`` goes between pins and links, ``program`` is the program.
"""
