// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.GraphicsEnvironment;
import java.awt.image.BufferedImage;
import java.io.ByteArrayOutputStream;
import java.io.File;
import java.io.IOException;
import java.lang.reflect.InvocationTargetException;
import java.nio.file.Files;
import javax.imageio.ImageIO;
import javax.swing.SwingUtilities;

import rhotrack.spy.scene.LcmSubscription;
import rhotrack.spy.scene.LcmUrlArgument;
import rhotrack.spy.scene.Model;

/** The viewer as a program without lcm-spy, in a window or as a picture. */
public final class Viewer {
    static final int WIDTH = 1280;
    static final int HEIGHT = 800;

    private static final String USAGE = """
            usage: rhotrack.spy.Viewer [-l URL | --lcm-url=URL] [--size WIDTHxHEIGHT] [--png FILE \
            [--after SECONDS]
                    [--select TRACK]]
              --lcm-url  the LCM network, as in LCM_DEFAULT_URL
              --size     of window or picture, pixels (1280x800)
              --png      no window (and no display): listen for a while, write this picture, and end
              --after    so long (10)
              --select   the track whose hypotheses are in the picture; 0: that with the most""";

    private int width = WIDTH;
    private int height = HEIGHT;
    private double seconds = 10;
    private File png;
    private Integer selected;
    private String url;

    private Viewer() {
    }

    /** Runs the viewer with the arguments in USAGE. */
    public static void main(String[] arguments)
            throws InterruptedException, InvocationTargetException {
        Viewer viewer = new Viewer();
        try {
            viewer.parseArguments(arguments);
        } catch (IllegalArgumentException e) {
            System.err.println(USAGE);
            System.exit(2);
        }
        try {
            viewer.run();
        } catch (IOException e) {
            System.err.println("rhotrack: " + e.getMessage());
            System.exit(1);
        }
    }

    private void run() throws IOException, InterruptedException, InvocationTargetException {
        if (png != null) {
            writePicture();
            System.exit(0); // LCM's thread would keep the process running
        }
        if (GraphicsEnvironment.isHeadless()) {
            throw new IOException("no display (--png needs none)");
        }
        Model model = new Model();
        LcmSubscription feed = new LcmSubscription(url, model);
        SwingUtilities.invokeAndWait(() -> {
            ViewerWindow window = new ViewerWindow(model, feed, width, height);
            window.whenClosed(() -> System.exit(0));
            window.open();
        });
    }

    private void parseArguments(String[] arguments) {
        url = LcmUrlArgument.fromArguments(arguments);
        for (int i = 0; i < arguments.length; i++) {
            String name = arguments[i];
            if (name.startsWith("--lcm-url=")) {
                continue;
            }
            if (i + 1 >= arguments.length) {
                throw new IllegalArgumentException(name);
            }
            String value = arguments[++i];
            switch (name) {
                case "-l", "--lcm-url" -> url = value;
                case "--size" -> parseSize(value);
                case "--png" -> png = new File(value);
                case "--select" -> selected = Integer.valueOf(value);
                case "--after" -> seconds = Double.parseDouble(value);
                default -> throw new IllegalArgumentException(name);
            }
        }
        if (!(seconds >= 0 && seconds <= 86400)) {
            throw new IllegalArgumentException("--after");
        }
    }

    private void parseSize(String value) {
        String[] sides = value.split("x", 2);
        width = Integer.parseInt(sides[0]);
        height = sides.length == 2 ? Integer.parseInt(sides[1]) : 0;
        if (width < 400 || height < 300 || width > 8000 || height > 8000) {
            throw new IllegalArgumentException(value);
        }
    }

    private void writePicture()
            throws IOException, InterruptedException, InvocationTargetException {
        System.setProperty("java.awt.headless", "true");
        Model model = new Model();
        // not closed: the process ends, and LCM would report an error on its socket
        new LcmSubscription(url, model);
        Thread.sleep((long) (1000 * seconds));
        BufferedImage[] image = new BufferedImage[1];
        SwingUtilities.invokeAndWait(() -> {
            AllViewsPanel panel = new AllViewsPanel(model);
            image[0] = panel.paintToImage(width, height);
            if (selected != null) {
                panel.selectTrack(selected);
                image[0] = panel.paintToImage(width, height);
            }
        });
        ByteArrayOutputStream bytes = new ByteArrayOutputStream();
        ImageIO.write(image[0], "png", bytes);
        try {
            Files.write(png.toPath(), bytes.toByteArray());
        } catch (IOException e) {
            throw new IOException("cannot write " + png, e);
        }
    }
}
