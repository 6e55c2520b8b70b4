// SPDX-License-Identifier: GPL-3.0-or-later
#include "share_surfaces.h"

#include <gmock/gmock.h>

#include <barrier>
#include <cstring>

#include "specimens.h"
#include "surf/core/error.h"
#include "surf/mesh/shapes.h"
#include "thread_team.h"

namespace surf::workflow {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

// Two threads that stand for the processes of a machine.
struct Machine {
  std::barrier<> meet{2};
  std::string told;
  std::shared_ptr<std::byte> memory;
};

class ThreadNode : public NodeMemory {
 public:
  ThreadNode(Machine& machine, int rank) : machine_(machine), rank_(rank) {}
  bool is_first() const override { return rank_ == 0; }
  int processes() const override { return 2; }
  void tell(std::string& bytes) override {
    if (is_first()) machine_.told = bytes;
    machine_.meet.arrive_and_wait();
    bytes = machine_.told;
    machine_.meet.arrive_and_wait();
  }
  std::shared_ptr<std::byte> allocate(std::size_t bytes) override {
    if (is_first())
      machine_.memory = {static_cast<std::byte*>(::operator new (bytes, std::align_val_t{64})),
                         [](std::byte* p) { ::operator delete (p, std::align_val_t{64}); }};
    machine_.meet.arrive_and_wait();
    return machine_.memory;
  }
  void share(std::byte*, std::size_t) override { machine_.meet.arrive_and_wait(); }

 private:
  Machine& machine_;
  int rank_;
};

mc::Specimen ball() {
  mc::Specimen s = test::flat("Si");
  s.bodies.push_back({"ball", make_sphere({0, 0, 30}, 20, 3), 0});
  return s;
}

mc::SceneSurfaces made() {
  const mc::Specimen s = ball();
  return mc::make_surfaces(s, mc::validate(s), {}, test::square_scan(100, 4), {});
}

template <class T>
bool same(const mc::SharedArray<T>& a, const mc::SharedArray<T>& b) {
  return a.values.size() == b.values.size() &&
         std::memcmp(a.values.data(), b.values.data(), a.values.size_bytes()) == 0;
}

TEST(ShareSurfaces, GivesAllProcessesTheFirstOnesInTheSameMemory) {
  Machine machine;
  mc::SceneSurfaces got[2];
  int calls = 0;
  const auto errors = test::on_ranks(2, [&](int rank) {
    ThreadNode node(machine, rank);
    got[rank] = share_surfaces(node, [&] {
      ++calls;
      return made();
    });
  });
  EXPECT_THAT(errors, testing::Each(IsEmpty()));
  EXPECT_EQ(calls, 1);
  const mc::SceneSurfaces expected = made();
  for (const mc::SceneSurfaces& s : got) {
    EXPECT_TRUE(same(s.mesh.vertices_nm, expected.mesh.vertices_nm));
    EXPECT_TRUE(same(s.mesh.triangles, expected.mesh.triangles));
    EXPECT_TRUE(same(s.mesh.shell_of, expected.mesh.shell_of));
    EXPECT_TRUE(same(s.mesh.local_nm, expected.mesh.local_nm));
    EXPECT_EQ(s.mesh.center_nm, expected.mesh.center_nm);
    EXPECT_EQ(s.shells.size(), expected.shells.size());
    EXPECT_EQ(s.solids.size(), expected.solids.size());
    EXPECT_EQ(s.plane_nm, expected.plane_nm);
    EXPECT_EQ(s.half_space, expected.half_space);
    EXPECT_EQ(s.box.lower_nm, expected.box.lower_nm);
    EXPECT_EQ(s.box.upper_nm, expected.box.upper_nm);
  }
  EXPECT_EQ(got[0].mesh.vertices_nm.values.data(), got[1].mesh.vertices_nm.values.data());
  machine.memory.reset();  // who has surfaces keeps their memory
  got[0] = {};
  EXPECT_TRUE(same(got[1].mesh.triangles, expected.mesh.triangles));
}

TEST(ShareSurfaces, FailsForAllWhereItFails) {
  Machine machine;
  const auto errors = test::on_ranks(2, [&](int rank) {
    ThreadNode node(machine, rank);
    share_surfaces(node, []() -> mc::SceneSurfaces {
      throw InvalidInput("specimen", "it is broken", "Mend it");
    });
  });
  EXPECT_THAT(errors[0], HasSubstr("it is broken"));
  EXPECT_THAT(errors[1], HasSubstr("it is broken"));
}

TEST(ShareSurfaces, NeedsNoMemoryForABareSubstrate) {
  Machine machine;
  const auto errors = test::on_ranks(2, [&](int rank) {
    ThreadNode node(machine, rank);
    const mc::Specimen flat = test::flat("Si");
    const mc::SceneSurfaces s = share_surfaces(node, [&] {
      return mc::make_surfaces(flat, mc::validate(flat), {}, test::square_scan(100, 4), {});
    });
    EXPECT_TRUE(s.mesh.empty());
    EXPECT_EQ(s.plane_nm, 0.0);
  });
  EXPECT_THAT(errors, testing::Each(IsEmpty()));
  EXPECT_EQ(machine.memory, nullptr);
}

}  // namespace
}  // namespace surf::workflow
