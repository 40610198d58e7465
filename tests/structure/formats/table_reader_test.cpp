// Models as tables: what a spreadsheet writes is understood or refused with the place, never misread.
#include <catch2/catch.hpp>

#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;

namespace {

using Tables = std::vector<std::pair<std::string, std::string>>;

Tables frame() {
  return {
      {"nodes.csv", "name,x,y,z\nA,0,0,0\nB,0,0,3.5\n"},
      {"materials.csv", "name,youngs_modulus,poisson_ratio,density\nS,210e9,0.3,7850\n"},
      {"sections.csv", "name,shape,depth,width\ncol,rectangle,0.3,0.2\n"},
      {"joints.csv", "name,rz,moment_y,strength\npin,0,,\nweak,,6e5,1.5\n"},
      {"members.csv", "name,kind,node1,node2,section,material,joint1,joint2,groups\nP,post,A,B,col,S,weak,pin,a;b c\n"},
      {"supports.csv", "node,x,y,z,rx,ry,rz\nA,fixed,fixed,5e7,fixed,fixed,fixed\nB,fixed,free,,,,\n"},
      {"loads.csv",
       "case,on,name,type,component,value,value2,from,to,frame\ndead,model,,self_weight,,1,,,,\n"
       "wind,node,B,force,y,1000,,,,\nwind,member,P,uniform,y,10,,,,\nwind,member,P,uniform,x,20,,,,\n"
       "wind,member,P,trapezoid,y,1,2,0.5,3,local\n"},
      {"combinations.csv", "name,case,factor\nall,dead,1.35\nall,wind,1.5\n"}};
}

Tables with(const std::string& file, const std::string& text) {
  Tables tables = frame();
  for (auto& [name, content] : tables)
    if (name == file) {
      content = text;
      return tables;
    }
  tables.emplace_back(file, text);
  return tables;
}

std::string message(const Tables& tables) {
  try {
    (void)parse_tables(tables, "m");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

const char* const nodes_header = "name,x,y,z\n";

}  // namespace

TEST_CASE("tables become the model that they describe") {
  const Building b = parse_tables(frame(), "m");
  REQUIRE(b.members.size() == 1);
  CHECK(b.members[0].kind == MemberKind::post);
  CHECK(b.members[0].groups == std::vector<std::string>{"a", "b c"});
  CHECK(b.joints[0].capacity.value[5] == 9e5);  // 6e5 times its strength
  CHECK(b.joints[1].stiffness[5] == 0);
  REQUIRE(b.supports.size() == 2);
  CHECK(b.supports[0].stiffness[2] == 5e7);
  CHECK(b.supports[1].stiffness[1] == 0);
  REQUIRE(b.cases.size() == 2);
  CHECK(b.cases[0].self_weight == Vec3(0, 0, -1));
  REQUIRE(b.cases[1].members.size() == 2);
  CHECK(b.cases[1].members[0].first.head<3>() == Vec3(20, 10, 0));
  CHECK(b.cases[1].members[1].last[1] == 2);
  CHECK(b.cases[1].members[1].frame == LoadFrame::local);
  REQUIRE(b.combinations.size() == 1);
  CHECK(b.combinations[0].factors[1].second == 1.5);
}

TEST_CASE("a spreadsheet's habits are understood") {
  CHECK(message(with("nodes.csv", "\xEF\xBB\xBFname,x,y,z\r\nA,0,0,0\r\nB,0,0,3.5\r\n\r\n")) == "accepted");
  CHECK(message(with("nodes.csv", "name,x,y,z,,\nA,0,0,0,,\nB, 0 ,0,3.5,,\n")) == "accepted");
  CHECK(message(with("nodes.csv", "\"name\",\"x\",y,z\n\"A\",\"0\",0,0\nB,0,0,+3.5E0\n")) == "accepted");
  // Semicolons between cells, decimal commas: 3,5 is three and a half.
  const Building b = parse_tables(with("nodes.csv", "name;x;y;z\nA;0;0;0\nB;0;0;3,5\n"), "m");
  CHECK(b.nodes[1].position.z() == 3.5);
  CHECK(parse_tables(with("nodes.csv", "name\tx\ty\tz\nA\t0\t0\t0\nB\t0\t0\t3.25\n"), "m").nodes[1].position.z() ==
        3.25);
}

TEST_CASE("what may be misread is refused with its place") {
  CHECK_THAT(message(with("nodes.csv", std::string(nodes_header) + "A,0,0,0\nB,0,0,3,5\n")),
             Catch::StartsWith("m/nodes.csv, line 3: 5 cells where the header has 4"));
  CHECK_THAT(message(with("nodes.csv", std::string(nodes_header) + "A,0,0,0\nB,0,0,\"3,5\"\n")),
             Catch::StartsWith("m/nodes.csv, line 3, z: found \"3,5\", a decimal comma"));
  CHECK_THAT(message(with("nodes.csv", "name;x;y;z\nA;0;0;0\nB;0;0,5;3.5\n")),
             Catch::StartsWith("m/nodes.csv, line 3, z: found \"3.5\", where other numbers"));
  CHECK_THAT(message(with("nodes.csv", "name;x;y;z\nA;0;0;0\nB;0;0;3.500\n")), Catch::Contains("may mean a thousand"));
  CHECK_THAT(message(with("nodes.csv", "name;x;y;z\nA;0;0;0\nB;0;0;1.234,5\n")),
             Catch::StartsWith("m/nodes.csv, line 3, z: found \"1.234,5\"; accepted: a number"));
  CHECK_THAT(message(with("nodes.csv", std::string("\xFF\xFEn\0a\0", 6))), Catch::Contains("not UTF-8"));
  CHECK_THAT(message(with("nodes.csv", "")), Catch::Contains("the table is empty"));
  CHECK_THAT(message(with("nodes.csv", std::string(nodes_header) + "A,0,0,0\nB,0,0,nan\n")),
             Catch::Contains("line 3, z"));
  CHECK_THAT(message(with("nodes.csv", std::string(nodes_header) + "A,0,0,0\n\"B,0,0,3\n")),
             Catch::Contains("not closed"));
}

TEST_CASE("what is wrong in tables is told by file and line") {
  CHECK(message(with("nodes.csv", "name,x,y,w\nA,0,0,0\n")) ==
        "m/nodes.csv, line 1: there is no column \"w\"; accepted: \"name\", \"x\", \"y\", \"z\"");
  CHECK_THAT(message(with("nodes.csv", std::string(nodes_header) + "A,0,0,0\nA,0,0,3\n")),
             Catch::StartsWith("m/nodes.csv, line 3, name: \"A\" stands twice, first in m/nodes.csv, line 2"));
  CHECK_THAT(message(with("members.csv", "name,kind,node1,node2,section,material\nP,post,A,X,col,S\n")),
             Catch::StartsWith("m/members.csv, line 2, members.P.nodes[1]: "));
  CHECK_THAT(message(with("members.csv", "name,kind,node1,node2,section,material\nP,post,A,B,,S\n")),
             Catch::StartsWith("m/members.csv, line 2, members.P: the key \"section\" is missing"));
  CHECK_THAT(message(with("supports.csv", "node,x\nA,held\n")),
             Catch::StartsWith("m/supports.csv, line 2, x: found \"held\""));
  CHECK_THAT(message(with("loads.csv", "case,on,name,type,component,value\nd,roof,A,force,z,1\n")),
             Catch::StartsWith("m/loads.csv, line 2, on: found \"roof\""));
  CHECK_THAT(message(with("loads.csv", "case,on,name,type,component,value\nd,node,A,force,z,1\nd,node,A,force,z,2\n")),
             Catch::StartsWith("m/loads.csv, line 3, component: \"z\" stands twice"));
  CHECK_THAT(message(with("loads.csv", "case,on,name,type,component,value,from\nd,node,A,force,z,1,2\n")),
             Catch::StartsWith("m/loads.csv, line 2, from: found \"2\""));
  CHECK_THAT(message(with("model.csv", "key,value\nlength,furlong\n")),
             Catch::StartsWith("m/model.csv, line 2, units.length"));
  CHECK_THAT(message(with("node.csv", nodes_header)), Catch::StartsWith("m: there is no table \"node.csv\""));
}

TEST_CASE("openings, diaphragms, masses and what a design check needs have tables and columns") {
  Tables tables = frame();
  for (auto& [name, content] : tables)
    if (name == "members.csv")
      content =
          "name,kind,node1,node2,section,material,design,factor_y,length_z,restraints\n"
          "P,post,A,B,col,S,,2,3.1,\nQ,post,A,C,col,S,none,,,\nR,,B,C,col,S,,,,continuous\n";
    else if (name == "nodes.csv")
      content = "name,x,y,z\nA,0,0,0\nB,0,0,3.5\nC,4,0,3.5\nD,4,0,0\n";
  tables.emplace_back("restraints.csv", "member;at\nP;1,5\nP;2,5\n");
  tables.emplace_back("panels.csv", "name,kind,node1,node2,node3,node4,thickness,material\nW,wall,A,D,C,B,0.2,S\n");
  tables.emplace_back("openings.csv",
                      "panel,opening,x,y\nW,door,1,0\nW,window,3,1\nW,door,2,0\nW,window,3.5,1\n"
                      "W,door,2,2.1\nW,window,3.5,2\n");
  tables.emplace_back("diaphragms.csv", "name,node\nroof,B\nroof,C\n");
  tables.emplace_back("masses.csv", "on,name,value,Ixx,Iyy,Izz\nload,wind,0.3,,,\nnode,C,12,1,2,3\nmember,R,7,,,\n");
  const Building b = parse_tables(tables, "m");
  CHECK(b.members[0].design.restraints == std::vector<double>{1.5, 2.5});
  CHECK(b.members[0].design.factors[0] == 2);
  CHECK(b.members[0].design.lengths[1] == 3.1);
  CHECK_FALSE(b.members[1].design.checked);
  CHECK(b.members[2].design.restrained_throughout);
  REQUIRE(b.panels[0].openings.size() == 2);
  CHECK(b.panels[0].openings[0] == std::vector<Vec2>{{1, 0}, {2, 0}, {2, 2.1}});
  CHECK(b.panels[0].openings[1] == std::vector<Vec2>{{3, 1}, {3.5, 1}, {3.5, 2}});
  REQUIRE(b.diaphragms.size() == 1);
  CHECK(b.diaphragms[0].nodes.size() == 2);
  REQUIRE(b.masses.nodes.size() == 1);
  CHECK(b.masses.nodes[0].mass == 12);
  CHECK(b.masses.nodes[0].inertia == Vec3(1, 2, 3));
  CHECK(b.masses.members[0].second == 7);
  CHECK(b.masses.loads[0].second == 0.3);
}

TEST_CASE("rows of lists that belong to nothing are told by file and line") {
  CHECK_THAT(message(with("restraints.csv", "member,at\nP,1\nX,2\n")),
             Catch::StartsWith("m/restraints.csv, line 3, member: there is no member \"X\""));
  CHECK_THAT(message(with("openings.csv", "panel,opening,x,y\nW,1,0,0\n")), Catch::Contains("openings.csv, line 2"));
  CHECK_THAT(message(with("diaphragms.csv", "name,node\nd,A\nd,X\n")),
             Catch::StartsWith("m/diaphragms.csv, line 3, diaphragms.d[1]: "));
  CHECK_THAT(message(with("masses.csv", "on,name,value\nroof,A,1\n")),
             Catch::StartsWith("m/masses.csv, line 2, on: found \"roof\""));
  CHECK_THAT(message(with("masses.csv", "on,name,value\nnode,A,1\nnode,A,2\n")),
             Catch::StartsWith("m/masses.csv, line 3, name: \"A\" stands twice"));
  CHECK_THAT(message(with("masses.csv", "on,name,value,Ixx,Iyy,Izz\nmember,P,1,2,3,4\n")),
             Catch::StartsWith("m/masses.csv, line 2, Ixx: the inertia of a member"));
  CHECK_THAT(message(with("masses.csv", "on,name,value,Ixx,Iyy,Izz\nnode,A,1,2,,4\n")),
             Catch::StartsWith("m/masses.csv, line 2, Iyy: the cell is empty"));
  const std::string header = "name,kind,node1,node2,section,material,design,factor_y,restraints\nP,post,A,B,col,S,";
  CHECK_THAT(message(with("members.csv", header + "none,2,\n")),
             Catch::StartsWith("m/members.csv, line 2, design: found \"none\" beside"));
  CHECK_THAT(message(with("members.csv", header + "some,,\n")),
             Catch::StartsWith("m/members.csv, line 2, design: found \"some\""));
  Tables both = with("members.csv", header + ",,none\n");
  both.emplace_back("restraints.csv", "member,at\nP,1\n");
  CHECK_THAT(message(both), Catch::StartsWith("m/members.csv, line 2, restraints: found \"none\" beside distances"));
}
