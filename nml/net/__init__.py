"""NML over a network: the server that offers buffers to remote programs, and the links of remote channels.

Server: ``protocol`` is what it answers (bytes in, bytes out, no sockets), ``served`` the buffers behind that,
``streams`` and ``packet_ports`` its sockets, ``stcp`` the questions as text, ``server`` the process ``linuxcncsvr``.
Client: ``remote`` is the channel to a buffer elsewhere, ``stream_links`` and ``packet_links`` how it gets there.
Both: ``wire`` has the words of the protocol, ``forms`` says how messages travel.
"""
