"""The fast part of ``hal.component``: its pins and parameters as items of a mapping."""

from hal._mapping cimport announce
from hal._records cimport Item, cell_value, set_cell


cdef class Items:
    """Values by a component's own short names."""

    cdef readonly dict items

    def __cinit__(self, *args, **kwargs):
        self.items = {}

    cdef Item find(self, name):
        item = self.items.get(name)
        if item is None:
            raise AttributeError(f"Pin '{name}' does not exist")
        return <Item>item

    def __getitem__(self, name):
        cdef Item item = self.find(name)
        return cell_value(item.cell(), item.item.type)

    def __setitem__(self, name, value):
        cdef Item item = self.find(name)
        set_cell(item.cell(), item.item.type, value)
        announce(item.mapping.at)

    def __contains__(self, name):
        return name in self.items

    def __iter__(self):
        return iter(self.items)

    def __len__(self):
        return len(self.items)

    def keep(self, str name, Item item) -> None:
        """Add a pin or parameter under a name."""
        self.items[name] = item

    def forget(self) -> None:
        """The component has left: there is nothing to read any more."""
        self.items.clear()
