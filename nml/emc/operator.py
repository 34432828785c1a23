"""Texts for the operator. They travel on emcError; each display shows them. Manual, chapter 4.1."""

from __future__ import annotations

from nml.emc.constants import LINELEN
from nml.message import Command, Message, char, integer


class NML_ERROR(Message, type_id=1):
    """An error text without sender."""

    error = char(256, cut=True)


class NML_TEXT(Message, type_id=2):
    """A text without sender."""

    text = char(256, cut=True)


class NML_DISPLAY(Message, type_id=3):
    """A text to be shown prominently, without sender."""

    display = char(256, cut=True)


class EMC_OPERATOR_ERROR(Command, type_id=11):
    """Something went wrong; the operator must see it."""

    id = integer(doc="0")
    error = char(LINELEN, wire=LINELEN + 1, cut=True)


class EMC_OPERATOR_TEXT(Command, type_id=12):
    """Something the operator may want to know."""

    id = integer()
    text = char(LINELEN, wire=LINELEN + 1, cut=True)


class EMC_OPERATOR_DISPLAY(Command, type_id=13):
    """Something the operator must see, such as a (MSG,...) comment."""

    id = integer()
    display = char(LINELEN, wire=LINELEN + 1, cut=True)
