/* gmsh_body ORDER WHOLE|HALF PREFIX: a block, 12 x 12 x 12 mm, with a round chamber of radius 3,
 * meshed by gmsh with elements of ORDER 1 or 2 and written by it as PREFIX-2.2.msh, PREFIX-2.2b.msh
 * (binary), PREFIX-4.1.msh and PREFIX-4.1b.msh. HALF: the part x > 0, with the group symmetry-x. */
#include <gmshc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BASE, TIP, CHAMBER, SYMMETRY, EXTERIOR, GROUPS, MAX_FACES = 32 };
static const char *const group_name[GROUPS] = {"base", "tip", "chamber1", "symmetry-x", "exterior"};

static void shape(int half, int *ierr)
{
    const double pi = acos(-1);
    int box[2] = {3, 1}, ball[2] = {3, 2}, *out = NULL, **map = NULL;
    size_t n = 0, *nmap = NULL, nn = 0;
    gmshModelOccAddBox(half ? 0 : -6, -6, 0, half ? 6 : 12, 12, 12, box[1], ierr);
    gmshModelOccAddSphere(0, 0, 6, 3, ball[1], -pi / 2, pi / 2, 2 * pi, ierr);
    gmshModelOccCut(box, 2, ball, 2, &out, &n, &map, &nmap, &nn, -1, 1, 1, ierr);
    gmshModelOccSynchronize(ierr);
    gmshFree(out);
    gmshFree(nmap);
    for (size_t k = 0; k < nn; k++)
        gmshFree(map[k]);
    gmshFree(map);
}

static int group_of(int face, int half, int *ierr)
{
    char *type = NULL;
    double low[3], high[3];
    gmshModelGetType(2, face, &type, ierr);
    gmshModelGetBoundingBox(2, face, &low[0], &low[1], &low[2], &high[0], &high[1], &high[2], ierr);
    const int chamber = type != NULL && strcmp(type, "Sphere") == 0;
    gmshFree(type);
    return chamber               ? CHAMBER
           : high[2] < 1         ? BASE
           : low[2] > 11         ? TIP
           : half && high[0] < 1 ? SYMMETRY
                                 : EXTERIOR;
}

static void add_groups(int half, int *ierr)
{
    int *face = NULL, list[GROUPS][MAX_FACES], body = 1;
    size_t n = 0, count[GROUPS] = {0};
    gmshModelGetEntities(&face, &n, 2, ierr);
    for (size_t k = 0; k + 1 < n && k < 2 * MAX_FACES; k += 2) {
        const int g = group_of(face[k + 1], half, ierr);
        list[g][count[g]++] = face[k + 1];
    }
    gmshFree(face);
    gmshModelAddPhysicalGroup(3, &body, 1, 1, ierr);
    gmshModelSetPhysicalName(3, 1, "body", ierr);
    for (int g = 0; g < GROUPS; g++) {
        if (count[g] == 0)
            continue;
        gmshModelAddPhysicalGroup(2, list[g], count[g], 2 + g, ierr);
        gmshModelSetPhysicalName(2, 2 + g, group_name[g], ierr);
    }
}

static void write_all(const char *prefix, int *ierr)
{
    static const char *const ending[4] = {"2.2", "2.2b", "4.1", "4.1b"};
    char path[512];
    for (int k = 0; k < 4; k++) {
        snprintf(path, sizeof path, "%s-%s.msh", prefix, ending[k]);
        gmshOptionSetNumber("Mesh.MshFileVersion", k < 2 ? 2.2 : 4.1, ierr);
        gmshOptionSetNumber("Mesh.Binary", k % 2, ierr);
        gmshWrite(path, ierr);
    }
}

int main(int argc, char **argv)
{
    if (argc != 4)
        return 2;
    char name[] = "gmsh_body", *args[] = {name, NULL};
    const int order = strcmp(argv[1], "2") == 0 ? 2 : 1, half = strcmp(argv[2], "half") == 0;
    int ierr = 0, failed = 0;
    gmshInitialize(1, args, 0, &ierr);
    gmshOptionSetNumber("General.Terminal", 0, &ierr);
    gmshOptionSetNumber("General.NumThreads", 1, &ierr);
    gmshOptionSetNumber("Mesh.MeshSizeMax", 2, &ierr);
    shape(half, &ierr);
    failed |= ierr;
    add_groups(half, &ierr);
    failed |= ierr;
    gmshModelMeshGenerate(3, &ierr);
    failed |= ierr;
    gmshModelMeshSetOrder(order, &ierr);
    failed |= ierr;
    write_all(argv[3], &ierr);
    failed |= ierr;
    gmshFinalize(&ierr);
    if (failed != 0)
        fprintf(stderr, "gmsh_body: gmsh failed\n");
    _Exit(failed != 0); /* gmsh leaks: no report of that */
}
