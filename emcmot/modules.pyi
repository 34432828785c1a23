class PlannerModule:
    name: str

class HomingModule:
    name: str

PLANNER: PlannerModule
HOMING: HomingModule
