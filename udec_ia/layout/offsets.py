"""AUTO-GENERATED from offsets/groups.table by `python -m offsets`; do not edit.

Offsets and sizes are tuples: for 1, 2 and 4 integers to a real.
"""

from udec_ia.layout.field_table import require_current

DIGEST = "e47cfe95fe143a605c5e0da4ba16643a6c8078cc08a37d05e8fd7a5779e9fd47"
require_current(DIGEST)

MRIG = 1  # rigid block
MSDEF = 2  # simply-deformable block
MFDEF = 3  # fully-deformable block
MCOR = 4  # corner
MCON = 5  # contact
MDOM = 6  # domain
MHIS = 7  # history
MBND = 8  # boundary condition
MSIG = 9  # signal
MRLX = 10  # relaxation
MFLW = 11  # follower
MSMD = 12  # summand
MOUT = 13  # water outside
MCRK = 14  # crack
MMBR = 15  # member
MBLT = 16  # bolt
MNOD = 17  # node
MELM = 18  # element
MBRK = 20  # breakable block
MFRC = 21  # fracture

FIXED = 1  # KBFIX: fixed
GIVEN_X = 2  # KBFIX: its x velocity is given
GIVEN_Y = 4  # KBFIX: its y velocity is given
GIVEN_TURN = 8  # KBFIX: its angular velocity is given
CORNER_CORNER = 1  # KCCOD: the arcs of two corners
CORNER_EDGE = 2  # KCCOD: an arc of block KB1 and an edge of block KB2
EDGE_CORNER = 3  # KCCOD: an edge of block KB1 and an arc of block KB2
VIRTUAL = 4  # KCCOD: no contact: it keeps the map together
ALONG_X = 1  # KGFIX and KUFIX: its x velocity is given
ALONG_Y = 2  # KGFIX and KUFIX: its y velocity is given
JOINT_SLIPS = 1  # KCJFLAG: it slips
JOINT_SLIPPED = 2  # KCJFLAG: it has slipped
JOINT_BROKEN = 4  # KCJFLAG: it has opened by tension, or never had a tensile strength
JOINT_GIVEN = 8  # KCJFLAG: its joint material was given by CHANGE
JOINT_STALE = 16  # KCJFLAG: its lengths are to be found again
JOINT_OPENS = 32  # KCJFLAG: it is open, or will be in a few cycles at its present rate
BEGINS_OPENING = 64  # KCJFLAG: it has got JOINT_OPENS in the last cycle
OPENS_BESIDE1 = 128  # KCJFLAG: the joint of the contact on side KD1 has JOINT_OPENS
OPENS_BESIDE2 = 256  # KCJFLAG: the joint of the contact on side KD2 has JOINT_OPENS
FLOWS = 0  # KVCODE: from what flows in and from the volume of the domain
HELD = 1  # KVCODE: it is held, at any volume
EXCAVATED = 2  # KVCODE: it is held at 0, as blocks were deleted there
CUT_FROM_OUTSIDE = 3  # KVCODE: a new one that the outside has filled; FLOWS from the next pass on
PRESSURE_OUTSIDE = 1  # KOKIND: pressure, not below 0, on the edge and at its contacts
FLOW_FROM_OUTSIDE = 2  # KOKIND: flow into each contact that lies on the edge
IMPERMEABLE = 3  # KOKIND: no flow
DRY = 4  # KOKIND: no water: the pressure is 0, and water only leaves
YIELDED = 1  # KASTAT and KMSTAT: it has yielded along its axis
SHEARED = 2  # KASTAT: it has yielded in shear
BROKEN = 4  # KASTAT and KMSTAT: it is broken, and carries nothing
EMBEDDED = 0  # KNSIDE: on both sides
ROCK_ON_RIGHT = 1  # KNSIDE: on the right
ROCK_ON_LEFT = 2  # KNSIDE: on the left
NODE_SLIPPED = 1  # KNSTAT: it has slipped
NODE_PARTED = 2  # KNSTAT: it has opened, and has neither tensile strength nor cohesion any more
OF_CABLE = 0  # KMKIND: it does not, as part of a cable
OF_BEAM = 1  # KMKIND: it does, as part of a beam
HINGED = 2  # KMSTAT: it has yielded by bending
CRACK_BY_FORCES = 1  # KFRK: two opposed contact forces
CRACK_BY_TENSION = 2  # KFRK: stress normal to the crack
CRACK_BY_SHEAR = 3  # KFRK: shear stress along the crack
TURNS = 4  # KUFIX: its angular velocity is given, as KUVX in rad/s
SUMMANDS = -2  # KHK: a sum over what summands name
WHOLE_MODEL = -1  # KHK: a sum over the whole model, or a greatest one
COMMON_BLOCK = 0  # KHK: a variable of the common block
UNDAMPED = 0  # LREST: not at all
LOCAL = 1  # LREST: opposes the velocity with the fraction f of every unbalanced force
COMBINED = 2  # LREST: takes half of that, and half against the change of the force
KINETIC = 3  # LREST: stops all motion when the kinetic energy has passed a peak
ADAPTIVE = 4  # LREST: is mass damping, with f the fraction of critical damping for what moves
AT_BLOCKS = 0  # JPHASE: before the block pass, where a cycle begins
AT_DOMAINS = 1  # JPHASE: before the domain pass
AT_CONTACTS = 2  # JPHASE: before the contact pass
AT_BROKEN = 3  # JPHASE: before the domain pass that follows contacts which were broken
AT_WAYS = 4  # JPHASE: before the ways of the corners of fast blocks are followed
COUPLED = 0  # LFLOW: deformation and flow
UNDRAINED = 1  # LFLOW: deformation alone
DRAINED = 2  # LFLOW: nothing
UNDEFINED_JOINT = 0  # JMLAW: the joint material is not defined
COULOMB_JOINT = 1  # JMLAW: Coulomb friction with cohesion and tensile strength
CONTINUOUSLY_YIELDING = 2  # JMLAW: friction that decreases with plastic displacement
BARTON_BANDIS = 3  # JMLAW: closure that remembers the largest stress, strength of a rough joint
JOINT_LAW2 = 4  # JMLAW: law jl2 of the user
JOINT_LAW3 = 5  # JMLAW: law jl3 of the user
JOINT_LAW4 = 6  # JMLAW: law jl4 of the user
JOINT_LAW5 = 7  # JMLAW: law jl5 of the user
PER_LENGTH = 0  # JMUNIT: a length, on which the stress is linear between two contacts
PER_CONTACT = 1  # JMUNIT: a contact, as in 1980
PER_LENGTH_AT_ENDS = 2  # JMUNIT: a length, half of which each of its two ends has (report 2.4)
SPRINGS_ALONE = 1  # JMSHORT: COULOMB_JOINT without dilation
LINEAR_BETWEEN = 2  # JMSHORT: not PER_LENGTH_AT_ENDS

# one block (page 53)
KB = (1, 1, 1)  # int: next block in block list; 0 at the end of the list
KP = (2, 2, 2)  # int corner!: one corner in the block's corner list
KMAT = (3, 3, 3)  # int 1..50: material number
KCONS = (4, 4, 4)  # int 1..5: constitutive number
KX = (6, 4, 3)  # real: x coordinate of centroid
KY = (7, 5, 4)  # real: y coordinate of centroid
KXD = (8, 6, 5)  # real: x velocity
KYD = (9, 7, 6)  # real: y velocity
KTD = (10, 8, 7)  # real: angular velocity (anticlockwise positive)
KBM = (11, 9, 8)  # real 0..: block mass; 0 until a density is known
KBI = (12, 10, 9)  # real 0..: block moment of inertia about the centroid
KBFX = (13, 11, 10)  # real: x centroid force-sum
KBFY = (14, 12, 11)  # real: y centroid force-sum
KBFT = (15, 13, 12)  # real: centroid moment sum
KBEX = (15, 26, 48)  # int: extension pointer (to SDEF or FDEF data); 0 for a rigid block
KBFIX = (16, 27, 49)  # int 0..2,4,6,8,10,12,14: 0 free, 1 fixed, else given: 2 in x, 4 in y, 8 its turning
KBB = (17, 28, 50)  # int: previous block in block list; 0 at the head of the list
KBROOM = (18, 29, 51)  # int 0..32767: way before it searches large domains, in RMAX/30000; 32767: on none
KBRO = (20, 16, 14)  # real 0..: greatest distance of a corner from the centroid
NVBL = (20, 32, 56)

# one corner of one block (page 53)
KL = (1, 1, 1)  # int item!: next corner or contact on block, clockwise
KR = (2, 2, 2)  # int corner!: next corner, anticlockwise
KNB = (3, 3, 3)  # int block!: host block
KXP = (5, 3, 2)  # real: x coordinate of corner
KYP = (6, 4, 3)  # real: y coordinate of corner
KXCP = (7, 5, 4)  # real: x coordinate of local circle centre
KYCP = (8, 6, 5)  # real: y coordinate of local circle centre
KRAD = (9, 7, 6)  # real: radius of local circle; negative at a concave corner
KXDP = (10, 8, 7)  # real: x velocity of corner
KYDP = (11, 9, 8)  # real: y velocity of corner
KGP = (11, 18, 32)  # int: grid-point of the corner; 0 unless the block is fully-deformable
KLB = (12, 19, 33)  # int item!: previous corner or contact on block, so anticlockwise
NVCR = (13, 20, 36)

# one contact: it stands in the clockwise lists of two blocks (page 54)
KC = (1, 1, 1)  # int: next contact in contact list; 0 at the end of the list
KB1 = (2, 2, 2)  # int block!: first block involved
KB2 = (3, 3, 3)  # int block!: second block involved
KL1 = (4, 4, 4)  # int item!: next item in the clockwise list of block KB1
KL2 = (5, 5, 5)  # int item!: next item in the clockwise list of block KB2
KD1 = (6, 6, 6)  # int domain!: domain to the left of the contact, going from KB1 to KB2
KD2 = (7, 7, 7)  # int domain!: domain to the right of the contact, going from KB1 to KB2
KCM = (8, 8, 8)  # int 1..50: material number
KCC = (9, 9, 9)  # int 1..5: constitutive number
KXC = (11, 6, 4)  # real: x contact coordinate
KYC = (12, 7, 5)  # real: y contact coordinate
KXDC = (13, 8, 6)  # real: relative x velocity (of block KB2 relative to block KB1)
KYDC = (14, 9, 7)  # real: relative y velocity
KCS = (15, 10, 8)  # real: relative shear displacement
KCN = (16, 11, 9)  # real: relative normal displacement: the overlap, negative for a gap
KCFS = (17, 12, 10)  # real: shear force
KCFN = (18, 13, 11)  # real: normal force (positive compression)
KCCOD = (18, 26, 44)  # int 1..4: 1 corner/corner, 2 corner/edge, 3 edge/corner, 4 virtual (ours)
KCP1 = (19, 27, 45)  # int corner!: first corner after the contact in the list of block KB1
KCP2 = (20, 28, 46)  # int corner!: first corner after the contact in the list of block KB2
KLB1 = (21, 29, 47)  # int item!: previous item in the clockwise list of block KB1
KLB2 = (22, 30, 48)  # int item!: previous item in the clockwise list of block KB2
KCB = (23, 31, 49)  # int: previous contact in contact list; 0 at the head of the list
NVCN = (24, 32, 52)

# one domain: a face of the map, bounded by blocks and contacts (page 54)
KD = (1, 1, 1)  # int: next domain in domain list; 0 at the end of the list
KPP = (3, 2, 2)  # real: pore-pressure for domain
KUMAX = (4, 3, 3)  # real: fictitious domain displacement since the last update
KDLOOP = (4, 6, 12)  # int: one contact in the anticlockwise list around the domain; 0 for a lone block
KDEX = (5, 7, 13)  # int: domain extension (edge-to-edge contact); 0 when there is none
KDB = (6, 8, 14)  # int: previous domain in domain list; 0 at the head of the list
KDLRG = (7, 9, 15)  # int 0..1: 1 if it is large: each of its blocks searches it for contacts (KBROOM)
NVDO = (8, 10, 16)

# simply-deformable extension of a block (page 55)
KED11 = (1, 1, 1)  # real: strain-rate tensor
KED12 = (2, 2, 2)  # real: strain-rate tensor
KED21 = (3, 3, 3)  # real: strain-rate tensor
KED22 = (4, 4, 4)  # real: strain-rate tensor
KS111 = (5, 5, 5)  # real: internal stress tensor
KS112 = (6, 6, 6)  # real: internal stress tensor
KS121 = (7, 7, 7)  # real: internal stress tensor
KS122 = (8, 8, 8)  # real: internal stress tensor
KSA11 = (9, 9, 9)  # real: applied stress tensor (multiplied by block area)
KSA12 = (10, 10, 10)  # real: applied stress tensor (multiplied by block area)
KSA21 = (11, 11, 11)  # real: applied stress tensor (multiplied by block area)
KSA22 = (12, 12, 12)  # real: applied stress tensor (multiplied by block area)
KSJ11 = (13, 13, 13)  # real: Euler tensor: integral of density x' x' about the centroid
KSJ12 = (14, 14, 14)  # real: Euler tensor: integral of density x' y'
KSJ22 = (15, 15, 15)  # real: Euler tensor: integral of density y' y'
KSAREA = (16, 16, 16)  # real 0..: block area
NVSD = (16, 32, 64)

# fully-deformable extension of a block: heads of its two lists (page ours)
KFG = (0, 0, 0)  # int: first grid-point of the block; 0 before GENERATE
KFZ = (1, 1, 1)  # int: first zone of the block; 0 before GENERATE
KFNG = (2, 2, 2)  # int 0..: number of grid-points
KFNZ = (3, 3, 3)  # int 0..: number of zones
KFMIX = (4, 4, 4)  # int 0..1: 1 if successive zones are pairs for mixed discretisation, else 0
KFS11 = (6, 4, 3)  # real: stress that the zones begin with
KFS12 = (7, 5, 4)  # real: stress that the zones begin with
KFS22 = (8, 6, 5)  # real: stress that the zones begin with
NVFD = (8, 12, 20)

# one triangular zone of a fully-deformable block (page 55)
KZ = (0, 0, 0)  # int: next zone in zone list; 0 at the end of the list
KZG = (1, 1, 1)  # int gridpoint!: the three surrounding grid-points
KZS11 = (5, 3, 2)  # real: stress tensor
KZS12 = (6, 4, 3)  # real: stress tensor
KZS22 = (7, 5, 4)  # real: stress tensor
KZM = (8, 6, 5)  # real 0..: zone mass
NVZO = (8, 12, 20)

# one grid-point (mass-point) of a fully-deformable block (page 55)
KG = (0, 0, 0)  # int: next grid-point in grid-point list; 0 at the end of the list
KCOR = (1, 1, 1)  # int: corresponding block corner; 0 inside the block
KXG = (3, 2, 2)  # real: x coordinate
KYG = (4, 3, 3)  # real: y coordinate
KXDG = (5, 4, 4)  # real: x velocity
KYDG = (6, 5, 5)  # real: y velocity
KGFX = (7, 6, 6)  # real: x force-sum
KGFY = (8, 7, 7)  # real: y force-sum
KGPM = (9, 8, 8)  # real 0..: grid-point mass
KGFIX = (9, 16, 32)  # int 0..3: velocities that are given, not calculated: 1 in x, 2 in y, 3 both
KGEDGE = (10, 17, 33)  # int 0..1: 1 if its corner is a point of an edge, which is not rounded, else 0
NVGP = (11, 18, 36)

# domain extension: data of an edge-to-edge contact (page ours)
KJL = (1, 1, 1)  # real: joint length p
KJUN = (2, 2, 2)  # real: mean normal displacement of the two ends
KJUS = (3, 3, 3)  # real: mean shear displacement of the two ends
KJSN = (4, 4, 4)  # real: average normal stress
KJTS = (5, 5, 5)  # real: average shear stress
NVDE = (5, 10, 20)

# joint at a contact: its material, stresses and lengths (page ours)
KCJMAT = (0, 0, 0)  # int -1..50: joint material; 0 for none, -1 for that of its blocks, per contact
KCJFLAG = (1, 1, 1)  # int 0..511: state of the joint, and whether its material was given by a range
KCJL = (3, 2, 2)  # real: joint length p: the length that is closed
KCJX = (4, 3, 3)  # real: distance of its resultant, or grid-point, from the contact, towards side KD2
KCJOFF = (5, 4, 4)  # real: offset: closure less overlap (KCN)
KCJSN = (6, 5, 5)  # real: normal stress (compression positive)
KCJTS = (7, 6, 6)  # real: shear stress
KCJUSL = (8, 7, 7)  # real: shear displacement (KCS) when the lengths were found
KCJSLIP = (9, 8, 8)  # real: plastic shear displacement
KCJP1 = (10, 9, 9)  # real 0..: distance of the contact on side KD1 to which stress is linear; 0 without one
KCJP2 = (11, 10, 10)  # real 0..: distance of the contact on side KD2 to which stress is linear; 0 without one
KCJOWN = (12, 11, 11)  # real 0..: length of its own, on which its stress is constant
KCJV1 = (13, 12, 12)  # real: state of the joint model, as its file in kernels/constitutive has it
KCJV2 = (14, 13, 13)  # real: the same, second number
KCJV3 = (15, 14, 14)  # real: the same, third number
KCJKN = (16, 15, 15)  # real 0..: normal stiffness, times length, that the time-step allows for
KCJKS = (17, 16, 16)  # real 0..: shear stiffness, times length, that the time-step allows for
NVJT = (17, 32, 64)

# edge that ends at a corner (page ours)
KEJ = (0, 0, 0)  # int 0..200: joint that made the edge (SPLIT ... JOINT); 0 for none
KEOUT = (1, 1, 1)  # int: condition of water on the edge where it is on the outside; 0 for none
NVED = (2, 2, 4)

# water in a domain (page ours)
KVCODE = (0, 0, 0)  # int 0..3: what its pressure follows
KVROW = (1, 1, 1)  # int 0..: row of the domain in the arrays of flow, counted from 0
KVSAT = (3, 2, 2)  # real 0..: saturation: part of the volume that is filled
KVVOL = (4, 3, 3)  # real 0..: volume, by unit of thickness
KVSTEP = (5, 4, 4)  # real 0..: volume that the time-step allows for; 0: none is known
KVLOST = (6, 5, 5)  # real: volume lost in this cycle, which the steps of flow take in; 0 between cycles
KVLEN = (7, 6, 6)  # real 0..: length of wall that the time-step allows for, KW KVLEN^2/KVVOL at a contact
KVX = (8, 7, 7)  # real: x coordinate of the point where the pressure is KPP
KVY = (9, 8, 8)  # real: y coordinate of that point
KVGX = (10, 9, 9)  # real: increase of a held pressure with x
KVGY = (11, 10, 10)  # real: increase of a held pressure with y
KVQ = (12, 11, 11)  # real: flow into the domain in the last step of flow
KVGIVN = (13, 12, 12)  # real: flow that PPRESSURE gives the domain
NVWA = (13, 24, 48)

# flow at a contact (page ours)
KPQ = (1, 1, 1)  # real: flow from domain KD1 to domain KD2 in the last step of flow
KPA = (2, 2, 2)  # real 0..: aperture
KPK = (3, 3, 3)  # real 0..: flow by difference of pressure, both domains filled
KPL1 = (4, 4, 4)  # real 0..: length of the joint in domain KD1 that is the contact's
KPL2 = (5, 5, 5)  # real 0..: length of the joint in domain KD2 that is the contact's
KPOUT = (5, 10, 20)  # int: condition of water at a contact on the outside; 0 for none
NVPI = (6, 12, 24)

# water outside: what BOUNDARY gives for edges (page ours)
KO = (1, 1, 1)  # int: next condition in the list; 0 at the end of the list
KOKIND = (2, 2, 2)  # int 1..4: kind of condition; of two at a contact the lower one counts
KOS = (3, 3, 3)  # int: signal that pressure or flow is multiplied by; 0 if constant
KOP = (5, 3, 2)  # real: pressure at x = 0 and y = 0
KOGX = (6, 4, 3)  # real: increase of the pressure with x
KOGY = (7, 5, 4)  # real: increase of the pressure with y
KOQ = (8, 6, 5)  # real: flow
NVOU = (8, 12, 20)

# a line that ends inside a block; it is kept until cuts meet it (page ours)
KK = (1, 1, 1)  # int: next crack in the list; 0 at the end of the list
KKJ = (2, 2, 2)  # int 0..200: number of its joint; 0 for none
KKX1 = (4, 3, 2)  # real: x of one end
KKY1 = (5, 4, 3)  # real: y of that end
KKX2 = (6, 5, 4)  # real: x of the other end
KKY2 = (7, 6, 5)  # real: y of that end
NVCK = (7, 12, 20)

# a block that belongs to a GROUP (page ours)
KI = (1, 1, 1)  # int: next member in the list; 0 at the end of the list
KIB = (2, 2, 2)  # int block!: block
KIN = (3, 3, 3)  # int 0..16383: name of the group: two characters in a word, the first one times 128
NVMB = (9, 10, 12)

# a bolt between points of two blocks: an axial and a shear spring (page ours)
KA = (1, 1, 1)  # int: next bolt in the list; 0 at the end of the list
KAB1 = (2, 2, 2)  # int block!: block of its first end
KAB2 = (3, 3, 3)  # int block!: block of its second end
KAZ1 = (4, 4, 4)  # int: zone of its first end; 0 in a block without zones
KAZ2 = (5, 5, 5)  # int: zone of its second end; 0 in a block without zones
KAMAT = (6, 6, 6)  # int 1..50: structural material number
KASTAT = (7, 7, 7)  # int 0..7: state, as flags
KAX1 = (9, 5, 3)  # real: x coordinate of its first end
KAY1 = (10, 6, 4)  # real: y coordinate of its first end
KAX2 = (11, 7, 5)  # real: x coordinate of its second end
KAY2 = (12, 8, 6)  # real: y coordinate of its second end
KALEN = (13, 9, 7)  # real 0..: length when it was made
KAFN = (14, 10, 8)  # real: axial force (tension positive)
KAFS = (15, 11, 9)  # real: shear force on its first end, to the left of the way from first to second end
KAPL = (16, 12, 10)  # real: plastic elongation
NVBT = (16, 24, 40)

# a node of a cable or beam: a mass that moves and turns, and its interface with a block (page ours)
KN = (1, 1, 1)  # int: next node in the list; 0 at the end of the list
KNBL = (2, 2, 2)  # int: block to which it is joined; 0 if there is none
KNZN = (3, 3, 3)  # int: zone to which it is joined; 0 in a block without zones
KNMAT = (4, 4, 4)  # int 1..50: structural material number
KNSIDE = (5, 5, 5)  # int 0..2: where the rock is, along the way from first to last node
KNSTAT = (6, 6, 6)  # int 0..3: state of the interface, as flags
KNX = (8, 5, 3)  # real: x coordinate
KNY = (9, 6, 4)  # real: y coordinate
KNANG = (10, 7, 5)  # real: rotation since it was made
KNXD = (11, 8, 6)  # real: x velocity
KNYD = (12, 9, 7)  # real: y velocity
KNTD = (13, 10, 8)  # real: angular velocity
KNFX = (14, 11, 9)  # real: x force-sum
KNFY = (15, 12, 10)  # real: y force-sum
KNFT = (16, 13, 11)  # real: moment sum
KNM = (17, 14, 12)  # real 0..: mass
KNI = (18, 15, 13)  # real 0..: moment of inertia
KNAX = (19, 16, 14)  # real: x coordinate of the point of its block to which it was joined
KNAY = (20, 17, 15)  # real: y coordinate of that point
KNLEN = (21, 18, 16)  # real 0..: length of its interface: half of the elements beside it that are in blocks
KNFN = (22, 19, 17)  # real: normal force of the interface (compression positive)
KNFS = (23, 20, 18)  # real: shear force of the interface on the block, along the way from first to last node
KNGAP = (24, 21, 19)  # real 0..: opening of the interface
KNTX = (25, 22, 20)  # real: x part of the direction from first to last node
KNTY = (26, 23, 21)  # real: y part of that direction
KNLX = (27, 24, 22)  # real: x unbalanced force in the cycle before (COMBINED, ADAPTIVE)
KNLY = (28, 25, 23)  # real: y unbalanced force in the cycle before
KNLT = (29, 26, 24)  # real: unbalanced moment in the cycle before
KNSM = (30, 27, 25)  # real 0..: mass over the inertial mass (FRACTION SCALED)
KNSI = (31, 28, 26)  # real 0..: moment of inertia over the inertial one
NVND = (31, 56, 104)

# an element of a cable or beam between two nodes (page ours)
KM = (1, 1, 1)  # int: next element in the list; 0 at the end of the list
KMN1 = (2, 2, 2)  # int node!: its first node
KMN2 = (3, 3, 3)  # int node!: its second node
KMMAT = (4, 4, 4)  # int 1..50: structural material number
KMKIND = (5, 5, 5)  # int 0..1: whether it resists bending
KMSTAT = (6, 6, 6)  # int 0..7: state, as flags
KMLEN = (8, 5, 3)  # real 0..: length when it was made
KMFN = (9, 6, 4)  # real: axial force (tension positive)
KMM1 = (10, 7, 5)  # real: moment on its first end, anticlockwise
KMM2 = (11, 8, 6)  # real: moment on its second end, anticlockwise
KMPL = (12, 9, 7)  # real: plastic elongation
NVEL = (12, 18, 28)

# strength of a block that may crack (page ours)
KBKN = (1, 1, 1)  # int: next one in the list; 0 at the end of the list
KBKB = (2, 2, 2)  # int block!: block
KBKT = (4, 3, 2)  # real 0..: tensile strength; 0: it does not crack in tension
KBKC = (5, 4, 3)  # real 0..: cohesion
KBKF = (6, 5, 4)  # real 0..: friction, a tangent; with cohesion 0 and friction 0 it does not crack in shear
KBKA = (7, 6, 5)  # real 0..: smallest area of a part
KBKJ = (7, 12, 20)  # int 0..200: joint that its cracks belong to; 0 for none
KBKW = (9, 8, 7)  # real 0..: time that it waits, as a wave has yet to relieve it
NVBK = (9, 16, 28)

# a crack that a run has made (page ours)
KFRN = (1, 1, 1)  # int: next one in the list, an earlier crack; 0 at the end of the list
KFRK = (2, 2, 2)  # int 1..3: cause
KFRC = (4, 3, 2)  # real 0..: cycle in which it was
KFRT = (5, 4, 3)  # real: time
KFRX1 = (6, 5, 4)  # real: x of one end
KFRY1 = (7, 6, 5)  # real: y of that end
KFRX2 = (8, 7, 6)  # real: x of the other end
KFRY2 = (9, 8, 7)  # real: y of that end
KFRE = (10, 9, 8)  # real: kinetic and strain energy before it less that after it
NVFR = (10, 18, 32)

# displacement of a block since DISPLACEMENTS or RESET DISPLACEMENTS (page ours)
KBDX = (1, 1, 1)  # real: x displacement of the centroid
KBDY = (2, 2, 2)  # real: y displacement of the centroid
KBDT = (3, 3, 3)  # real: rotation (anticlockwise positive)
NVDS = (3, 6, 12)

# displacement of a grid-point since then (page ours)
KGDX = (1, 1, 1)  # real: x displacement
KGDY = (2, 2, 2)  # real: y displacement
NVPD = (2, 4, 8)

# one boundary condition on a grid-point, a block, or a corner of a block (page ours)
KU = (1, 1, 1)  # int: next condition in the list; 0 at the end of the list
KUB = (2, 2, 2)  # int block!: block that it acts on
KUG = (3, 3, 3)  # int: grid-point of the block that it acts on; 0 if it acts on the block
KUP = (4, 4, 4)  # int: corner of the block that it acts on; 0 if it does not act on a corner
KUQ = (5, 5, 5)  # int: other end of the edge whose load it carries; 0 if it is not on an edge
KUS = (6, 6, 6)  # int: signal that load and velocity are multiplied by; 0 if constant
KUFIX = (7, 7, 7)  # int 0..4: velocities that are given: 1 in x, 2 in y, 3 both, 4 the angular velocity
KUFX = (9, 5, 3)  # real: force in x
KUFY = (10, 6, 4)  # real: force in y
KUVX = (11, 7, 5)  # real: velocity in x; the angular velocity in rad/s if KUFIX is 4
KUVY = (12, 8, 6)  # real: velocity in y
KUCXX = (13, 9, 7)  # real: viscous resistance in x to velocity in x
KUCXY = (14, 10, 8)  # real: viscous resistance in x to velocity in y, and in y to velocity in x
KUCYY = (15, 11, 9)  # real: viscous resistance in y to velocity in y
NVBN = (15, 22, 36)

# a factor that changes with time: a sine or a FUNCTION (page ours)
KT = (1, 1, 1)  # int: next signal in the list; 0 at the end of the list
KTNUM = (2, 2, 2)  # int 0..: number of the FUNCTION; 0 for a sine
KTP = (3, 3, 3)  # int: first point of the function; 0 for a sine
KTFREQ = (5, 3, 2)  # real: frequency of the sine
KTBEG = (6, 4, 3)  # real: time at which the sine began
KTLAST = (7, 5, 4)  # real: time for which the sine lasts
KTNOW = (8, 6, 5)  # real: the factor in the present cycle
KTREST = (9, 7, 6)  # real: what a real cannot hold of the time at which the sine began: KTBEG + KTREST
NVSG = (9, 14, 24)

# one point of a FUNCTION (page ours)
KTPN = (0, 0, 0)  # int: next point, later in time; 0 at the end of the function
KTPT = (2, 2, 2)  # real: time
KTPF = (3, 3, 3)  # real: factor
NVTP = (3, 6, 12)

# a number of the common block that follows a FUNCTION (page ours/3)
KW = (1, 1, 1)  # int: next follower in the list; 0 at the end of the list
KWS = (2, 2, 2)  # int signal!: FUNCTION that the number follows
KWN = (3, 3, 3)  # int 0..: the number: index into the reals of the common block, counted from 0
KWB = (5, 3, 2)  # real: value that the factor of the FUNCTION multiplies
NVFW = (5, 6, 8)

# one history: a number that is recorded every so many cycles (page ours)
KH = (1, 1, 1)  # int: next history in history list; 0 at the end of the list
KHB = (2, 2, 2)  # int: previous history in history list; 0 at the head of the list
KHG = (3, 3, 3)  # int: group whose field is recorded; 0 when it has gone, or for no group
KHK = (4, 4, 4)  # int -2..: kind of that group, as it comes in this table; 0 common block, -1 and -2 sums
KHF = (5, 5, 5)  # int 0..: number of the field in its group, counted from 0
KHN = (6, 6, 6)  # int 1..: cycles from one recording to the next
NVHI = (7, 8, 8)

# a block or grid-point whose reaction a history adds to its sum (page ours/3)
KQ = (1, 1, 1)  # int: next summand in the list; 0 at the end of the list
KQH = (2, 2, 2)  # int history!: history
KQB = (3, 3, 3)  # int block!: block
KQG = (4, 4, 4)  # int: grid-point of the block; 0 if it is the block itself
NVSM = (5, 6, 8)

# relaxation of one block or grid-point (page ours/2)
KRX = (1, 1, 1)  # int: next relaxation in the list; 0 at the end of the list
KRXB = (2, 2, 2)  # int block!: block
KRXG = (3, 3, 3)  # int: grid-point of the block; 0 if it is that of the block itself
KRXM = (5, 3, 2)  # real 0..: mass over the inertial mass
KRXI = (6, 4, 3)  # real 0..: moment of inertia over the inertial one; 0 for a grid-point
KRXE = (7, 5, 4)  # real 0..: Euler tensor over the inertial one; 0 unless the block is simply-deformable
KRXFX = (8, 6, 5)  # real: x unbalanced force in the cycle before
KRXFY = (9, 7, 6)  # real: y unbalanced force in the cycle before
KRXFT = (10, 8, 7)  # real: unbalanced moment in the cycle before
KRXS11 = (11, 9, 8)  # real: what strained the block in the cycle before
KRXS12 = (12, 10, 9)  # real: what strained the block in the cycle before
KRXS22 = (13, 11, 10)  # real: what strained the block in the cycle before
NVRX = (13, 22, 40)

# The common block, type int: index of the variable, or of its first element
JUNK = 0  # list of spare memory groups; 0 when there are none
MFREE = 1  # first unused memory address
MTOP = 2  # size of the main array; groups end at or below this address
NCYC = 3  # currently requested number of cycles
MCTOT = 4  # total number of cycles
NERR = 5  # error number raised by a compiled routine; 0 when there is none
IBPNT = 6  # list of blocks; 0 when there are none
ICPNT = 7  # list of contacts; 0 when there are none
IDPNT = 8  # list of domains; 0 when there are none
IODPNT = 9  # outer domain; 0 when there are no blocks
IBNPNT = 10  # list of boundary conditions; 0 when there are none
ISGPNT = 11  # list of signals; 0 when there are none
IHPNT = 12  # list of histories; 0 when there are none
IRXPNT = 13  # list of relaxations; 0 when there are none
IFWPNT = 14  # list of followers; 0 when there are none
ISMPNT = 15  # list of summands; 0 when there are none
IOUPNT = 16  # list of conditions of water outside; 0 when there are none
ICKPNT = 17  # list of cracks that are kept; 0 when there are none
IMBPNT = 18  # list of members of groups; 0 when there are none
IBTPNT = 19  # list of bolts; 0 when there are none
INDPNT = 20  # list of nodes; 0 when there are none
IELPNT = 21  # list of elements; 0 when there are none
IBRPNT = 22  # list of breakable blocks; 0 when there are none
IFRPNT = 23  # list of fractures, the last one first; 0 when there are none
LCRACK = 24  # 1 if blocks are to crack before the next cycle, else 0
NBLK = 25  # number of blocks
NCON = 26  # number of contacts
NDOM = 27  # number of domains
NVIRT = 28  # number of virtual contacts among them
NSOFT = 29  # number of deformable blocks
NMADE = 30  # contacts made so far
NBROKE = 31  # contacts broken so far
LSHORT = 32  # 1 if an edge holds, or has held, little more than its two roundings, else 0
LSAFE = 33  # 1 if the time-step is a fraction of the safe bound, 0 of the estimate
LENER = 34  # 1 if an account of the energy is kept (ENERGY ON), else 0
LREST = 35  # how unbalanced forces or velocities are damped beside ALPHA and BETA
LSCALE = 36  # 1 if inertial masses are scaled (FRACTION ... SCALED), else 0
MSCALE = 37  # contacts made, NMADE, when a safe step or masses were found last
LROUND = 38  # 1 if the rounding length was given by ROUND, 0 if it is our default
IERAD = 39  # address of the group that raised error NERR; 0 when there is none
NWANT = 40  # words that the interrupted routine asks for; 0 when there are enough
NSPARE = 41  # words that must be free before a cycle or a cut begins; 0 if IA() cannot grow
LLARGE = 42  # 1 if a domain is large (KDLRG), else 0
NDUE = 43  # 1 if a block is to search large domains in this cycle, else 0
LOUTS = 44  # 1 if blocks beyond OUTX1 ... OUTY2 are deleted while cycling (DELETE OUTSIDE), else 0
NLEFT = 45  # number of blocks deleted there
NTIPS = 46  # contacts that the last search refused because a tip stands in their gap
JPHASE = 47  # pass of the cycle to be resumed after memory was found; 0 for none
NSPOIL = 48  # number of the error that has ended a run of this state; 0 for none
MCSPOI = 49  # cycle in which that was; 0 for none
LJOINT = 50  # 1 if a joint lies behind each contact and an edge behind each corner, else 0
LSTIFF = 51  # 1 if a joint has become stiffer by a tenth since the time-step was found, else 0
NSEEN = 52  # contacts made and broken, NMADE + NBROKE, when joints were found last
LDISP = 53  # 1 if its displacement lies behind each block and each grid-point, else 0
LWATER = 54  # 1 if water lies behind each domain and a pipe behind each joint, else 0
LFLOW = 55  # what changes pressures in a cycle
NFEVRY = 56  # cycles from one pass of flow to the next
NFLOW = 57  # steps of flow in the last pass of flow
JMLAW = 58  # joint model, joint material I
JMUNIT = 108  # what stiffness and strength belong to, joint material I
JMSHORT = 158  # short steps that its joints can take, joint material I: found when a CYCLE begins
JMB1 = 208  # block material on one side; 0 if the joint material is not that of a pair of materials
JMB2 = 258  # block material on the other side
JLINE = 308  # joint material of joint I (SPLIT ... JOINT); 0 if it has none
LREADY = 508  # 1 if masses and time-step are those of the state, 0 if the next CYCLE is to find them
NCOMI = 509

# The common block, type real: index of the variable, or of its first element
TDEL = 0  # time-step
FRAC = 1  # requested fraction of critical time-step
ALPHA = 2  # mass damping coefficient
BETA = 3  # stiffness damping coefficient
CON1 = 4  # damping factor 1 - ALPHA.TDEL/2
CON2 = 5  # damping factor 1/(1 + ALPHA.TDEL/2)
ALPB = 6  # internal mass damping coefficient for simply deformable blocks
C1B = 7  # damping factor derived from ALPB
C2B = 8  # damping factor derived from ALPB
RESTF = 9  # of LOCAL and COMBINED: fraction of the unbalanced force; of ADAPTIVE: of critical damping
PSCALE = 10  # plotting scale; 0 lets the plot fill its frame
ATOL = 11  # distance between particles at which a contact is first formed
BTOL = 12  # distance between particles at which a contact is broken
CTOL = 13  # maximum overlap allowed when forming contacts
DTOL = 14  # rounding length
DTOL2 = 15  # =DTOL/2 (maximum contact overlap)
ETOL = 16  # limit on maximum domain displacement to trigger contact update
FTOL = 17  # least distance between two contacts of the same two blocks (our use)
GTOL = 18  # slack on the border between two contact codes (our use)
HTOL = 19  # largest displacement that may wait for the domain pass (our use)
GRAVX = 20  # x gravitational acceleration
GRAVY = 21  # y gravitational acceleration
UPEND = 22  # displacement that waits to be added to every KUMAX
WKW = 23  # bulk modulus of water
WDENS = 24  # density of water
WVISC = 25  # viscosity of water
FDEL = 26  # greatest stable step of flow; 0 if nothing flows
AKN = 27  # normal joint stiffness, material I
AKS = 77  # shear joint stiffness, material I
AMU = 127  # joint friction coefficient, material I
COH = 177  # joint cohesion, material I
DENS = 227  # density, material I
BULK = 277  # bulk modulus, material I
SHEAR = 327  # shear modulus, material I
ALAM1 = 377  # Lame constant, material I
ALAM2 = 427  # Lame constant, material I
JDIL = 477  # joint dilation: tangent of the dilation angle, material I
RMU = 527  # residual joint friction coefficient, material I
RCOH = 577  # residual joint cohesion, material I
UCRIT = 627  # slip at which a joint has reached its residual strength, material I
BMU = 677  # internal friction coefficient of block material, material I
BCOH = 727  # cohesion of block material, material I
BTEN = 777  # tensile strength of block material, material I
BDIL = 827  # dilation of block material: tangent of the dilation angle, material I
PAR1 = 877  # a number for the user's own laws, material I
PAR2 = 927  # a number for the user's own laws, material I
PAR3 = 977  # a number for the user's own laws, material I
PAR4 = 1027  # a number for the user's own laws, material I
JMKN = 1077  # normal stiffness, joint material I
JMKS = 1127  # shear stiffness, joint material I
JMMU = 1177  # friction, a tangent, joint material I
JMCOH = 1227  # cohesion, joint material I
JMTEN = 1277  # tensile strength, joint material I
JMDIL = 1327  # dilation, a tangent, joint material I
JMCRIT = 1377  # slip at which dilation ends; 0: never, joint material I
JMRMU = 1427  # friction after the first slip or opening, a tangent; negative: as before, joint material I
JMRCO = 1477  # cohesion after the first slip or opening; -1: as before, joint material I
JMJRC = 1527  # joint roughness coefficient, joint material I
JMJCS = 1577  # compressive strength of the walls, joint material I
JMSC = 1627  # compressive strength of the rock, joint material I
JMAPER = 1677  # aperture without load; 0: from JMJRC, JMJCS and JMSC, joint material I
JMKNI = 1727  # initial normal stiffness of BARTON_BANDIS, joint material I
JMUM1 = 1777  # greatest closure of BARTON_BANDIS in its first loading, joint material I
JMUM3 = 1827  # greatest closure of BARTON_BANDIS in later load cycles, joint material I
JMEN = 1877  # exponent of the normal stiffness, joint material I
JMES = 1927  # exponent of the shear stiffness, joint material I
JMKN1 = 1977  # least normal stiffness, joint material I
JMKN2 = 2027  # greatest normal stiffness; 0 for no limit, joint material I
JMKS1 = 2077  # least shear stiffness, joint material I
JMKS2 = 2127  # greatest shear stiffness; 0 for no limit, joint material I
JMIMU = 2177  # initial friction, a tangent, joint material I
JMR = 2227  # roughness, a length, joint material I
JMP1 = 2277  # number for laws of your own, joint material I
JMP2 = 2327  # number for laws of your own, joint material I
JMP3 = 2377  # number for laws of your own, joint material I
JMP4 = 2427  # number for laws of your own, joint material I
JMHAP = 2477  # aperture for water without stress: JMAPER or what BARTON_BANDIS has, joint material I
JMRAP = 2527  # least aperture; 0: a tenth of JMHAP, joint material I
JMMAP = 2577  # greatest aperture for flow; 0: no limit, joint material I
JMKC = 2627  # permeability factor of a corner; 0: cubic law, joint material I
STYM = 2677  # Young's modulus, structural material I
STAREA = 2727  # area of the cross-section by unit of thickness, structural material I
STI = 2777  # second moment of the cross-section by unit of thickness, structural material I
STDENS = 2827  # density of cables and beams, structural material I
STKN = 2877  # axial stiffness of a bolt; normal one of an interface by length, structural material I
STKS = 2927  # shear stiffness of a bolt; of an interface by length, structural material I
STYF = 2977  # yield force along the axis; 0: no limit, structural material I
STSF = 3027  # shear strength of a bolt; 0: no limit, structural material I
STBRK = 3077  # plastic strain that breaks; 0: none does, structural material I
STMY = 3127  # yield moment of a beam; 0: no limit, structural material I
STMU = 3177  # friction of an interface, a tangent, structural material I
STCOH = 3227  # cohesion of an interface, shear strength of grout, structural material I
STTEN = 3277  # tensile strength of an interface, structural material I
OUTX1 = 3327  # least x of centroids for DELETE OUTSIDE
OUTX2 = 3328  # greatest x
OUTY1 = 3329  # least y
OUTY2 = 3330  # greatest y
ZINER = 3331  # greatest moment of inertia of a block with zones over that of the body, as GENERATE found it
RMAX = 3332  # greatest KBROOM of a block on a large domain; 0: to be found
ULOOK = 3333  # displacement within a domain since open contacts looked at their neighbours
NCOMR = 3334

# The common block, type double: index of the variable, or of its first element
TIME = 0  # time since the first cycle
WFRIC = 1  # work done against friction so far, and shear that was lost as contacts opened
WBOUND = 2  # work of the boundary conditions since ENERGY ON
WMASS = 3  # energy taken by mass damping and by INTERNAL since ENERGY ON
WSTIF = 4  # energy taken by stiffness damping since ENERGY ON
WYIELD = 5  # work on deformable blocks that their elasticity has not kept since ENERGY ON
WSHAPE = 6  # work that changes of shape take without a force that shows it since ENERGY ON
WCRACK = 7  # energy that cracks have taken since ENERGY ON
EPUT = 8  # energy there at ENERGY ON and put in by commands since; taken out: negative
ESTOR = 9  # kinetic energy and strain energy when the last CYCLE ended
EPOT = 10  # potential of gravity then, against that at ENERGY ON
EREF = 11  # potential of gravity against the origin that counts as 0
WREST = 12  # energy taken by LOCAL, COMBINED and KINETIC damping since ENERGY ON
EMOVES = 13  # kinetic energy in the cycle before (KINETIC), or of cycles before, fading (ADAPTIVE)
WDRIVE = 14  # work that the boundary conditions have put in so far, not less what they have taken
WWAIT = 15  # time since the last pass of flow
WATIN = 16  # water that has come in from outside and from held domains, less what has left
WATPUT = 17  # water that commands have put in, less what they have taken
WATMAP = 18  # water gained as domains changed otherwise than by motion
WATERW = 19  # work of the pressures on blocks since ENERGY ON
WPUMPW = 20  # work of pressures outside and held ones on the water since ENERGY ON
WHEADW = 21  # work of gravity on the water that flows since ENERGY ON
WVISCW = 22  # energy of the water lost to its viscosity since ENERGY ON
NCOMD = 23
