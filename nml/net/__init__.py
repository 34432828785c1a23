"""NML over a network: the server that offers buffers to remote programs, and the links of remote channels.

``wire`` the words of the protocol, ``protocol`` what a server answers (bytes in, bytes out, no sockets), ``served`` the
buffers behind it, ``streams`` its connections, ``server`` the process ``linuxcncsvr``; ``remote`` is the channel to a
buffer elsewhere, ``links`` how it gets there. ``datagram``, ``stcp`` and ``serial_line`` are other ways to ask for the
same things.
"""
