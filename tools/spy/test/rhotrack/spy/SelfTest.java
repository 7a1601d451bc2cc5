// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Dimension;
import java.awt.FontMetrics;
import java.awt.Graphics2D;
import java.awt.Rectangle;
import java.awt.geom.Rectangle2D;
import java.awt.image.BufferedImage;
import java.util.ArrayList;
import java.util.List;

import rhotrack.spy.scene.Bounds;
import rhotrack.spy.scene.DisplayedTrack;
import rhotrack.spy.scene.Ellipse;
import rhotrack.spy.scene.Geometry;
import rhotrack.spy.scene.LcmUrlArgument;
import rhotrack.spy.scene.ListAssembler;
import rhotrack.spy.scene.LookHistory;
import rhotrack.spy.scene.LocalPoint;
import rhotrack.spy.scene.TracksWithTrails;

/** The viewer's parts without a display or a network: `make spy-test`. */
public final class SelfTest {
    private static final Checks CHECK = new Checks();

    private SelfTest() {
    }

    /** Exit code 1 where a check failed. */
    public static void main(String[] arguments) {
        CHECK.group("geometry", SelfTest::geometry);
        CHECK.group("ellipse", SelfTest::ellipse);
        CHECK.group("scale", SelfTest::scale);
        CHECK.group("view", SelfTest::view);
        CHECK.group("bounds", SelfTest::bounds);
        CHECK.group("assembler", SelfTest::assembler);
        CHECK.group("looks", SelfTest::looks);
        CHECK.group("tracks", SelfTest::tracks);
        CHECK.group("labels", SelfTest::labels);
        CHECK.group("url", SelfTest::url);
        CHECK.group("windows", SelfTest::windows);
        CHECK.group("columns", SelfTest::columns);
        CHECK.group("status line", SelfTest::statusLine);
        MessagesToPictureTest.run(CHECK);
        System.exit(CHECK.report() ? 0 : 1);
    }

    private static void geometry() {
        LocalPoint sensor = new LocalPoint(1000, -2000);
        LocalPoint north = Geometry.fromPolar(sensor, 500, Math.PI / 2, 0);
        CHECK.near("polar x", 1000, north.x());
        CHECK.near("polar y", -1500, north.y());
        CHECK.near("a slant range shrinks with elevation", 1250,
                Geometry.fromPolar(sensor, 500, 0, Math.PI / 3).x());
        CHECK.near("east", 90, Geometry.compassDegrees(1, 0));
        CHECK.near("north-west", 315, Geometry.compassDegrees(-1, 1));
        for (double course = -3; course < 3.2; course += 0.1) {
            double vx = 200 * Math.cos(course);
            double vy = 200 * Math.sin(course);
            Geometry.Line line = Geometry.lineThroughTrack(3000, -700, vx, vy);
            CHECK.isTrue("theta in [0, pi) for course " + course,
                    line.theta() >= 0 && line.theta() < Math.PI);
            CHECK.near("the place is on the line", line.rho(),
                    3000 * Math.cos(line.theta()) - 700 * Math.sin(line.theta()));
            CHECK.near("so is a later one", line.rho(), (3000 + 9 * vx) * Math.cos(line.theta())
                    + (-700 + 9 * vy) * Math.sin(line.theta()));
        }
        CHECK.isTrue("NaN is no place", !new LocalPoint(Double.NaN, 0).isWithinLimits());
    }

    private static void ellipse() {
        Ellipse upright = Ellipse.of(4, 0, 9);
        CHECK.near("major", 3, upright.major());
        CHECK.near("minor", 2, upright.minor());
        CHECK.near("along y", 1, Math.abs(Math.sin(upright.angle())));
        double c = Math.cos(0.4);
        double s = Math.sin(0.4);
        Ellipse turned = Ellipse.of(100 * c * c + 4 * s * s, 96 * c * s, 100 * s * s + 4 * c * c);
        CHECK.near("turned major", 10, turned.major());
        CHECK.near("turned minor", 2, turned.minor());
        CHECK.near("turned angle", 0.4, turned.angle());
        CHECK.near("a line has no width", 0, Ellipse.of(1, 1, 1).minor());
        CHECK.equal("not positive", null, Ellipse.of(1, 2, 1));
        CHECK.equal("negative", null, Ellipse.of(-1, 0, 1));
        CHECK.equal("nothing", null, Ellipse.of(0, 0, 0));
        CHECK.equal("NaN", null, Ellipse.of(Double.NaN, 0, 1));
        CHECK.equal("infinite", null, Ellipse.of(Double.POSITIVE_INFINITY, 0, 1));
    }

    private static void scale() {
        CHECK.near("1", 1, RoundStepsAndLengths.roundStep(1));
        CHECK.near("2", 2, RoundStepsAndLengths.roundStep(1.01));
        CHECK.near("5000", 5000, RoundStepsAndLengths.roundStep(2100));
        CHECK.near("10000", 10000, RoundStepsAndLengths.roundStep(5001));
        CHECK.near("0.2", 0.2, RoundStepsAndLengths.roundStep(0.11));
        CHECK.near("of nothing", 1, RoundStepsAndLengths.roundStep(0));
        CHECK.near("of NaN", 1, RoundStepsAndLengths.roundStep(Double.NaN));
        CHECK.equal("km", "20 km", RoundStepsAndLengths.formatLength(20000, 5000));
        CHECK.equal("parts of a km", "1.5 km", RoundStepsAndLengths.formatLength(1500, 500));
        CHECK.equal("m", "50 m", RoundStepsAndLengths.formatLength(50, 50));
        CHECK.equal("small steps far out", "1.05 km", RoundStepsAndLengths.formatLength(1050, 50));
        CHECK.equal("negative", "\u22124 km", RoundStepsAndLengths.formatLength(-4000, 2000));
    }

    private static void view() {
        ViewTransform view = new ViewTransform();
        view.resize(800, 600);
        view.fit(new Bounds(-1000, 0, 3000, 1000), 50);
        CHECK.near("west at the margin", 50, view.screenX(-1000));
        CHECK.near("east at the other", 750, view.screenX(3000));
        CHECK.near("one scale, 1:1", view.screenX(1000) - view.screenX(0),
                view.screenY(0) - view.screenY(1000));
        CHECK.near("middle", 300, view.screenY(500));
        double x = view.worldX(200);
        double y = view.worldY(100);
        double before = view.metresPerPixel();
        view.zoomAbout(200, 100, 1.7);
        CHECK.near("nearer", before / 1.7, view.metresPerPixel());
        CHECK.near("the place under the pointer stays, x", x, view.worldX(200));
        CHECK.near("the place under the pointer stays, y", y, view.worldY(100));
        view.pan(30, -40);
        CHECK.near("panned right", x, view.worldX(230));
        CHECK.near("panned up", y, view.worldY(60));
        for (int i = 0; i < 500; i++) {
            view.zoomAbout(1, 1, 3);
        }
        CHECK.isTrue("there is an end to zooming",
                view.metresPerPixel() > 0 && Double.isFinite(view.worldX(0)));
        long start = System.nanoTime();
        RangeRingsAndAxesLayer.paint(
                new BufferedImage(800, 600, BufferedImage.TYPE_INT_RGB).createGraphics(),
                view, 800, 600);
        CHECK.isTrue("rings of any size are quickly drawn",
                System.nanoTime() - start < 2_000_000_000L);
        view.fit(new Bounds(5, 5, 5, 5), 50);
        CHECK.near("a single place is in the middle", 400, view.screenX(5));
    }

    private static void bounds() {
        CHECK.equal("of nothing", null, Bounds.of(List.of()));
        List<LocalPoint> places = new ArrayList<>();
        for (int i = 0; i < 100; i++) {
            places.add(new LocalPoint(i, -i));
        }
        places.add(new LocalPoint(1e6, 1e6));
        CHECK.near("a stray one is left out", 98, Bounds.ofMost(places).east());
        CHECK.near("but is there", 1e6, Bounds.of(places).east());
        Bounds all = new Bounds(0, 0, 1, 1).union(new Bounds(-1, 0, 0, 2));
        CHECK.equal("union", new Bounds(-1, 0, 1, 2), all);
        CHECK.near("farthest corner", 5,
                new Bounds(-1, -1, 3, 4).farthestFrom(new LocalPoint(0, 0)));
    }

    private static void assembler() {
        ListAssembler<String> lists = new ListAssembler<>();
        CHECK.equal("a part waits", 0, lists.add(1, 7, 1, 2, List.of("b")).size());
        CHECK.equal("twice the same waits, too", 0, lists.add(1, 7, 1, 2, List.of("x")).size());
        List<ListAssembler.Assembled<String>> whole = lists.add(1, 7, 0, 2, List.of("a"));
        CHECK.equal("all parts, in order", List.of("a", "b"), whole.get(0).items());
        CHECK.isTrue("complete", whole.get(0).complete());
        CHECK.equal("a late duplicate is nothing", 0, lists.add(1, 7, 0, 2, List.of("a")).size());
        CHECK.equal("an empty list is one", 1, lists.add(1, 8, 0, 1, List.of()).size());
        lists.add(1, 9, 2, 3, List.of("c"));
        List<ListAssembler.Assembled<String>> two = lists.add(1, 10, 0, 1, List.of("d"));
        CHECK.equal("a newer list pushes the old one out", 2, two.size());
        CHECK.equal("with what it has", List.of("c"), two.get(0).items());
        CHECK.isTrue("incomplete", !two.get(0).complete());
        CHECK.equal("its late part is nothing", 0, lists.add(1, 9, 0, 3, List.of("a")).size());
        CHECK.equal("after a restart numbers count anew", 1,
                lists.add(2, 10, 0, 1, List.of("e")).size());
        CHECK.equal("a log in a loop goes on", 1, lists.add(1, 7, 0, 1, List.of("f")).size());
        CHECK.equal("no such part", 0, lists.add(1, 20, 2, 2, List.of("g")).size());
        CHECK.equal("no parts", 0, lists.add(1, 20, 0, 0, List.of("g")).size());
        lists.add(1, 21, 0, 2, List.of("h"));
        CHECK.equal("parts that disagree", 0, lists.add(1, 21, 1, 3, List.of("i")).size());
        CHECK.equal("do no harm", 1, lists.add(1, 21, 1, 2, List.of("i")).size());
    }

    private static void looks() {
        CHECK.equal("the whole circle", 1, LookHistory.looksPerTurn(0, 0));
        CHECK.equal("also so", 1, LookHistory.looksPerTurn(-Math.PI, Math.PI));
        CHECK.equal("quarters", 4, LookHistory.looksPerTurn(0, Math.PI / 2));
        CHECK.equal("over the seam", 4, LookHistory.looksPerTurn(1.75 * Math.PI, 0.25 * Math.PI));
        LookHistory<String> history = new LookHistory<>(4);
        for (int scan = 0; scan < 6; scan++) {
            history.add(0, scan, 1, "first of " + scan);
            history.add(0, scan, 1, "second of " + scan);
        }
        List<LookHistory.Faded<String>> fading = history.contentsWithStrength();
        CHECK.equal("the last four looks", 8, fading.size());
        CHECK.equal("oldest first", "first of 2", fading.get(0).content());
        CHECK.near("the oldest is faint", 0.25, fading.get(1).strength());
        CHECK.near("the newest is not", 1, fading.get(7).strength());
        history.add(1, 0, 1, "anew");
        CHECK.equal("a restart clears", 1, history.contentsWithStrength().size());
    }

    private static DisplayedTrack mark(int id, DisplayedTrack.Status status, double x) {
        return new DisplayedTrack(id, status, new LocalPoint(x, 0), 0, 1, 0, 1, 0, 1, null);
    }

    private static void tracks() {
        TracksWithTrails store = new TracksWithTrails();
        DisplayedTrack one = mark(1, DisplayedTrack.Status.CONFIRMED, 10);
        DisplayedTrack two = mark(2, DisplayedTrack.Status.TENTATIVE, 20);
        store.applyList(new ListAssembler.Assembled<>(1, 1, true, List.of(one, two)));
        CHECK.equal("both", List.of(one, two), store.tracks());
        store.applyList(new ListAssembler.Assembled<>(1, 2, false, List.of(one)));
        CHECK.equal("a missing part takes none away", 2, store.tracks().size());
        CHECK.equal("trails go with their tracks", 2, store.trails().get(0).size());
        for (int scan = 3; scan < 20; scan++) {
            store.applyList(new ListAssembler.Assembled<>(1, scan, false, List.of(one)));
        }
        CHECK.equal("but not for ever", List.of(one), store.tracks());
        store.applyList(new ListAssembler.Assembled<>(1, 20, true,
                List.of(mark(1, DisplayedTrack.Status.DELETED, 0))));
        CHECK.equal("deleted", 0, store.tracks().size());
        store.applyList(new ListAssembler.Assembled<>(1, 21, true, List.of(one)));
        store.applyList(new ListAssembler.Assembled<>(2, 1, false, List.of(two)));
        CHECK.equal("another tracker begins with nothing", List.of(two), store.tracks());
        CHECK.equal("tentative ones last", List.of(one, two),
                DisplayedTrack.byImportance(List.of(two, one)));
        DisplayedTrack fast = new DisplayedTrack(1, DisplayedTrack.Status.CONFIRMED,
                new LocalPoint(0, 0), 0, 200, 0, 1, 0, 1, null);
        CHECK.near("vectors of a round time", 20, TrackLayer.vectorSeconds(List.of(fast), 100));
        CHECK.near("nothing moves", 0, TrackLayer.vectorSeconds(List.of(), 100));
    }

    private static void labels() {
        LabelPlacer placer = new LabelPlacer(400, 300);
        Rectangle2D first = placer.placeLabel(200, 150, 6, 50, 14);
        Rectangle2D second = placer.placeLabel(200, 150, 6, 50, 14);
        CHECK.isTrue("two labels of one place do not overlap", !first.intersects(second));
        CHECK.equal("none outside", null, placer.placeLabel(-5, 100, 6, 50, 14));
        CHECK.isTrue("at the edge it turns inwards",
                placer.placeLabel(396, 20, 6, 50, 14).getMaxX() <= 398);
        placer.blockArea(0, 0, 400, 300);
        CHECK.equal("no room", null, placer.placeLabel(100, 100, 6, 50, 14));
    }

    private static void url() {
        CHECK.equal("default", null, LcmUrlArgument.fromArguments("-x"));
        CHECK.equal("-l", "udpm://a", LcmUrlArgument.fromArguments("-Dx", "-l", "udpm://a"));
        CHECK.equal("--lcm-url", "udpm://b", LcmUrlArgument.fromArguments("--lcm-url", "udpm://b"));
        CHECK.equal("--lcm-url=", "udpm://c", LcmUrlArgument.fromArguments("--lcm-url=udpm://c"));
        CHECK.equal("-l without one", null, LcmUrlArgument.fromArguments("-l"));
    }

    private static void windows() {
        Dimension wanted = new Dimension(1280, 800);
        Rectangle screen = new Rectangle(0, 30, 1920, 1050);
        Rectangle[] others = {new Rectangle(100, 100, 600, 500), new Rectangle(1300, 200, 600, 500),
            new Rectangle(50, 40, 1800, 300), new Rectangle(50, 780, 1800, 300),
            new Rectangle(0, 30, 1920, 155)};
        for (Rectangle other : others) {
            Rectangle place = WindowBesideAnother.beside(screen, other, wanted);
            CHECK.isTrue("beside " + other + ": " + place, place != null && !place.intersects(other)
                    && screen.contains(place));
        }
        CHECK.equal("as large as wanted where there is room", wanted,
                WindowBesideAnother.beside(new Rectangle(0, 0, 3840, 2160), others[0], wanted)
                        .getSize());
        CHECK.equal("smaller where there is less", new Rectangle(700, 100, 1220, 800),
                WindowBesideAnother.beside(screen, others[0], wanted));
        CHECK.equal("nowhere", null,
                WindowBesideAnother.beside(screen, new Rectangle(200, 200, 1500, 800), wanted));
        Rectangle second = new Rectangle(1920, 0, 1920, 1080);
        CHECK.isTrue("on a second screen", second.contains(
                WindowBesideAnother.beside(second, new Rectangle(2000, 100, 600, 500), wanted)));
    }

    private static void columns() {
        Graphics2D g = new BufferedImage(10, 10, BufferedImage.TYPE_INT_RGB).createGraphics();
        DisplayedTrack far = new DisplayedTrack(65535, DisplayedTrack.Status.CONFIRMED,
                new LocalPoint(0, 0), 123456, 19000, 0, 99999, 0, 123456.7, null);
        String[] cells = TrackTable.cellsOf(far, 0.996);
        CHECK.equal("existence per cent", "100 %", cells[4]);
        CHECK.equal("0 is known", "0 %", TrackTable.cellsOf(far, 0.0)[4]);
        CHECK.equal("existence that is not known", "\u2013", TrackTable.cellsOf(far, null)[4]);
        double[] widths = TrackTable.columnWidths(g, List.<String[]>of(cells));
        for (int room = 60; room < 900; room += 7) {
            double[] edges = TableColumnWidths.rightEdges(widths, room);
            double before = 0;
            for (int i = 0; i < edges.length; i++) {
                CHECK.isTrue("cells do not touch in " + room, edges[i] - widths[i] >= before
                        + (edges.length > 1 ? TableColumnWidths.LEAST_GAP : 0));
                before = edges[i];
            }
            CHECK.isTrue("nor leave the table", before <= room + 1e-9);
        }
        CHECK.equal("all of them where there is room", 7,
                TableColumnWidths.rightEdges(widths, 900).length);
        CHECK.isTrue("the last ones go first",
                TableColumnWidths.rightEdges(widths, 200).length < 7);
        CHECK.near("up to the edge", 900, TableColumnWidths.rightEdges(widths, 900)[6]);
    }

    private static void statusLine() {
        FontMetrics font = new BufferedImage(10, 10, BufferedImage.TYPE_INT_RGB).createGraphics()
                .getFontMetrics(Palette.PLAIN);
        List<List<StatusLine.Piece>> groups = new ArrayList<>();
        for (int i = 0; i < 12; i++) {
            groups.add(List.of(new StatusLine.Piece(Palette.TEXT, "group " + i, 12),
                    new StatusLine.Piece(Palette.TEXT, "of two", 12)));
        }
        CHECK.equal("one row where there is room", 1,
                StatusLine.wrapIntoRows(groups, 5000, font).size());
        CHECK.equal("one row of nothing", 1, StatusLine.wrapIntoRows(List.of(), 100, font).size());
        for (int room = 200; room < 2000; room += 50) {
            List<List<StatusLine.Piece>> rows = StatusLine.wrapIntoRows(groups, room, font);
            for (List<StatusLine.Piece> row : rows) {
                CHECK.isTrue("a row fits in " + room, StatusLine.widthOf(row, font) <= room + 26);
                CHECK.isTrue("groups stay together", row.get(0).text().startsWith("group"));
            }
            CHECK.equal("nothing is missing", 36, rows.stream().mapToInt(List::size).sum());
        }
        CHECK.isTrue("a narrow window has more rows",
                StatusLine.wrapIntoRows(groups, 300, font).size() > 3);
    }
}
