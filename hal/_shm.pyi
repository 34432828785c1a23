"""Types of the compiled tables; the texts are in ``_shm.pyx``."""

from hal._mapping import Mapping
from hal._records import (
    BIT as BIT,
)
from hal._records import (
    FLOAT as FLOAT,
)
from hal._records import (
    IN as IN,
)
from hal._records import (
    IO as IO,
)
from hal._records import (
    OUT as OUT,
)
from hal._records import (
    PORT as PORT,
)
from hal._records import (
    RO as RO,
)
from hal._records import (
    RW as RW,
)
from hal._records import (
    S32 as S32,
)
from hal._records import (
    S64 as S64,
)
from hal._records import (
    U32 as U32,
)
from hal._records import (
    U64 as U64,
)
from hal._records import Comp, Funct, Item, Signal, Thread

PIN: int
PARAM: int
USER: int
REALTIME: int
THREAD_COMP: int

class Segment(Mapping):
    def used(self) -> dict[str, tuple[int, int, int]]: ...
    def new_item(self, kind: int, name: str, type: int, dir: int, owner: int) -> Item: ...
    def find_item(self, kind: int, name: str) -> Item | None: ...
    def items(self, kind: int) -> list[Item]: ...
    def new_signal(self, name: str, type: int) -> Signal: ...
    def find_signal(self, name: str) -> Signal | None: ...
    def signals(self) -> list[Signal]: ...
    def new_comp(self, name: str, kind: int, pid: int, start: int) -> Comp: ...
    def find_comp(self, name: str) -> Comp | None: ...
    def comps(self) -> list[Comp]: ...
    def new_funct(self, name: str, owner: int, code: int, arg: int, uses_fp: bool, reentrant: bool) -> Funct: ...
    def find_funct(self, name: str) -> Funct | None: ...
    def functs(self) -> list[Funct]: ...
    def new_thread(self, name: str, owner: int, period_ns: int, uses_fp: bool) -> Thread: ...
    def find_thread(self, name: str) -> Thread | None: ...
    def threads(self) -> list[Thread]: ...
